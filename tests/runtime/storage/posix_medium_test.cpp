// The file: what is written is there when it is opened again; what cannot be used says why.
#include "runtime/storage/posix_medium.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "runtime/storage/slot_store.hpp"

namespace ipos::runtime {
namespace {

namespace fs = std::filesystem;

class PosixFile : public ::testing::Test {
 protected:
  PosixFile() {
    std::string name = (fs::temp_directory_path() / "ipos-nv-XXXXXX").string();
    folder_ = mkdtemp(name.data());
    path_ = (folder_ / "unit1.nv").string();
  }
  ~PosixFile() override { fs::remove_all(folder_); }
  fs::path folder_;
  std::string path_;
};

TEST_F(PosixFile, KeepsWhatIsStored) {
  NvContent content;
  content.values.emplace_back(8470, 2500);
  {
    auto medium = open_posix_medium(path_, FileUse::Write);
    ASSERT_TRUE(medium) << medium.error();
    SlotStore store(**medium, 1);
    EXPECT_EQ(store.load().outcome, NvOutcome::Fresh);
    EXPECT_EQ(store.save(content), std::nullopt);
    EXPECT_EQ(store.save(content), std::nullopt);
  }
  auto medium = open_posix_medium(path_, FileUse::Read);
  ASSERT_TRUE(medium) << medium.error();
  EXPECT_EQ(SlotStore(**medium, 1).load().content, content);
}

TEST_F(PosixFile, IsLockedWhileItIsOpen) {
  auto first = open_posix_medium(path_, FileUse::Write);
  ASSERT_TRUE(first);
  EXPECT_EQ(open_posix_medium(path_, FileUse::Write).error(), "another run is using it");
  EXPECT_EQ(open_posix_medium(path_, FileUse::Read).error(), "another run is using it");
  first->reset();
  EXPECT_TRUE(open_posix_medium(path_, FileUse::Read));
}

TEST_F(PosixFile, SaysWhyItCannotBeUsed) {
  EXPECT_EQ(open_posix_medium(path_, FileUse::Read).error(), "No such file or directory");
  EXPECT_EQ(open_posix_medium((folder_ / "no" / "unit1.nv").string(), FileUse::Write).error(),
            "No such file or directory");
  EXPECT_EQ(open_posix_medium(folder_.string(), FileUse::Write).error(), "Is a directory");
  EXPECT_EQ(open_posix_medium(folder_.string(), FileUse::Read).error(), "not a file");
}

TEST_F(PosixFile, AReaderCannotWrite) {
  { ASSERT_TRUE(open_posix_medium(path_, FileUse::Write)); }
  auto medium = open_posix_medium(path_, FileUse::Read);
  ASSERT_TRUE(medium);
  const uint8_t byte = 1;
  EXPECT_EQ((*medium)->write(0, {&byte, 1}), "Bad file descriptor");
}

}  // namespace
}  // namespace ipos::runtime
