// The file: what is written is there when it is opened again; what cannot be used says why.
#include "runtime/nv_memory/medium/file_medium.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <filesystem>
#include <iterator>

#include "runtime/nv_memory/medium/slot_store.hpp"
#include "tests/runtime/nv_memory/file_folder.hpp"

namespace ipos::runtime {
namespace {

namespace fs = std::filesystem;

class PosixFile : public FileFolder {};

TEST_F(PosixFile, KeepsWhatIsStored) {
  NvContent content;
  content.values.emplace_back(8470, 2500);
  {
    auto medium = open_file_medium(path_, FileUse::Write);
    ASSERT_TRUE(medium) << medium.error();
    SlotStore store(**medium, 1);
    EXPECT_EQ(store.load().outcome, NvOutcome::Fresh);
    EXPECT_EQ(store.save(content), std::nullopt);
    EXPECT_EQ(store.save(content), std::nullopt);
  }
  auto medium = open_file_medium(path_, FileUse::Look);
  ASSERT_TRUE(medium) << medium.error();
  EXPECT_EQ(SlotStore(**medium, 1).load().content, content);
}

TEST_F(PosixFile, IsLockedWhileItIsOpen) {
  auto first = open_file_medium(path_, FileUse::Write);
  ASSERT_TRUE(first);
  EXPECT_EQ(open_file_medium(path_, FileUse::Write).error(), "another run is using it");
  EXPECT_TRUE(open_file_medium(path_, FileUse::Look)) << "beside a run";
  first->reset();
  EXPECT_TRUE(open_file_medium(path_, FileUse::Write));
}

TEST_F(PosixFile, SaysWhyItCannotBeUsed) {
  EXPECT_EQ(open_file_medium((folder_ / "no" / "unit1.nv").string(), FileUse::Write).error(),
            "No such file or directory");
  const std::string pipe = (folder_ / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_symlink("loop", folder_ / "loop");
  for (const FileUse use : {FileUse::Write, FileUse::Look}) {
    EXPECT_EQ(open_file_medium(folder_.string(), use).error(), "not a file");
    EXPECT_EQ(open_file_medium(pipe, use).error(), "not a file");
    EXPECT_EQ(open_file_medium("/dev/zero", use).error(), "not a file");
    EXPECT_EQ(open_file_medium((folder_ / "loop").string(), use).error(),
              "Too many levels of symbolic links");
  }
}

// The owner may write it, everybody may read it, as far as the user's mask allows.
TEST_F(PosixFile, ANewFileIsTheOwnersToWrite) {
  for (const mode_t mask : {mode_t{0}, mode_t{022}, mode_t{077}}) {
    fs::remove(path_);
    const mode_t before = umask(mask);
    const auto medium = open_file_medium(path_, FileUse::Write);
    umask(before);
    ASSERT_TRUE(medium);
    struct stat status {};
    ASSERT_EQ(stat(path_.c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 07777, 0644U & ~mask);
  }
}

// Neither the file nor its folder, which is synchronised, stays open.
TEST_F(PosixFile, LeavesNothingOpen) {
  const auto open_now = [] {
    return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator());
  };
  const auto before = open_now();
  for (const FileUse use : {FileUse::Write, FileUse::Look}) {
    ASSERT_TRUE(open_file_medium(path_, use));
    ASSERT_FALSE(open_file_medium(folder_.string(), use));
    ASSERT_FALSE(open_file_medium((folder_ / "no" / "unit1.nv").string(), FileUse::Write));
    EXPECT_EQ(open_now(), before);
  }
}

TEST_F(PosixFile, WhoLooksMakesNothingAndChangesNothing) {
  const uint8_t byte = 1;
  uint8_t found = 0;
  {
    auto medium = open_file_medium(path_, FileUse::Look);
    ASSERT_TRUE(medium) << medium.error();
    EXPECT_EQ((*medium)->read(0, {&found, 1}), 0U);
    EXPECT_EQ((*medium)->write(2, {&byte, 1}), std::nullopt);
    EXPECT_EQ((*medium)->read(2, {&found, 1}), 1U) << "its copy can be written";
  }
  EXPECT_FALSE(fs::exists(path_));
  { ASSERT_EQ((*open_file_medium(path_, FileUse::Write))->write(0, {&byte, 1}), std::nullopt); }
  auto medium = open_file_medium(path_, FileUse::Look);
  ASSERT_TRUE(medium);
  EXPECT_EQ((*medium)->read(0, {&found, 1}), 1U);
  const std::array<uint8_t, 4> other{2, 2, 2, 2};
  EXPECT_EQ((*medium)->write(0, other), std::nullopt);
  EXPECT_EQ(fs::file_size(path_), 1U);
}

}  // namespace
}  // namespace ipos::runtime
