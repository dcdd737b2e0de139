// The file when the system interrupts a call, does a part of it or fails: this program has reading, writing and
// synchronising of files for itself.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numeric>
#include <vector>

#include "runtime/nv_memory/medium/file_medium.hpp"
#include "tests/runtime/nv_memory/file_folder.hpp"

namespace {

// What happens to the next calls.
struct Trouble {
  int interruptions = 0;
  size_t most = SIZE_MAX;  // bytes of one call
  int error = 0;           // of calls that are not interrupted
  int sync_error = 0;
  int calls = 0;
  int syncs = 0;
} g_trouble;

template <typename Call>
ssize_t troubled(size_t count, Call call) {
  ++g_trouble.calls;
  if (g_trouble.interruptions > 0) {
    --g_trouble.interruptions;
    errno = EINTR;
    return -1;
  }
  if (g_trouble.error != 0) {
    errno = g_trouble.error;
    return -1;
  }
  return call(std::min(count, g_trouble.most));
}

}  // namespace

extern "C" {

ssize_t pread(int file, void* bytes, size_t count, off_t offset) {
  return troubled(count, [&](size_t part) { return syscall(SYS_pread64, file, bytes, part, offset); });
}
ssize_t pwrite(int file, const void* bytes, size_t count, off_t offset) {
  return troubled(count, [&](size_t part) { return syscall(SYS_pwrite64, file, bytes, part, offset); });
}
int fsync(int file) {
  ++g_trouble.syncs;
  if (g_trouble.sync_error == 0) return static_cast<int>(syscall(SYS_fsync, file));
  errno = g_trouble.sync_error;
  return -1;
}
}

namespace ipos::runtime {
namespace {

namespace fs = std::filesystem;

class FileCalls : public FileFolder {
 protected:
  FileCalls() { g_trouble = {}; }
  ~FileCalls() override { g_trouble = {}; }

  std::unique_ptr<NvMedium> opened(FileUse use = FileUse::Write) {
    auto medium = open_file_medium(path_, use);
    EXPECT_TRUE(medium) << medium.error();
    return medium ? std::move(*medium) : nullptr;
  }
  std::vector<uint8_t> content() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static std::vector<uint8_t> numbered(size_t count) {
    std::vector<uint8_t> bytes(count);
    std::iota(bytes.begin(), bytes.end(), uint8_t{1});
    return bytes;
  }
};

TEST_F(FileCalls, InterruptedAndInParts) {
  const auto medium = opened();
  const std::vector<uint8_t> bytes = numbered(20);
  g_trouble = {2, 7, 0, 0, 0, 0};
  EXPECT_EQ(medium->write(5, bytes), std::nullopt);
  EXPECT_EQ(g_trouble.calls, 2 + 3) << "interrupted twice, then 7, 7 and 6 bytes";
  std::vector<uint8_t> expected(5);
  expected.insert(expected.end(), bytes.begin(), bytes.end());
  EXPECT_EQ(content(), expected);
  g_trouble = {2, 7, 0, 0, 0, 0};
  std::vector<uint8_t> found(20);
  EXPECT_EQ(medium->read(5, found), 20U);
  EXPECT_EQ(g_trouble.calls, 2 + 3);
  EXPECT_EQ(found, bytes);
}

// What `errno` says counts only after a call that failed.
TEST_F(FileCalls, AnInterruptionOfBeforeIsForgotten) {
  const auto medium = opened();
  const std::vector<uint8_t> bytes = numbered(3);
  errno = EINTR;
  EXPECT_EQ(medium->write(0, bytes), std::nullopt);
  std::vector<uint8_t> found(3);
  errno = EINTR;
  EXPECT_EQ(medium->read(0, found), 3U);
  EXPECT_EQ(g_trouble.calls, 2);
  EXPECT_EQ(found, bytes);
}

TEST_F(FileCalls, TheEndOfTheFile) {
  const auto medium = opened();
  ASSERT_EQ(medium->write(0, numbered(5)), std::nullopt);
  std::vector<uint8_t> found(8, 99);
  EXPECT_EQ(medium->read(3, found), 2U);
  EXPECT_EQ(found, (std::vector<uint8_t>{4, 5, 99, 99, 99, 99, 99, 99}));
  EXPECT_EQ(medium->read(5, found), 0U);
  EXPECT_EQ(medium->read(0, {}), 0U);
  g_trouble.calls = 0;
  EXPECT_EQ(medium->write(0, {}), std::nullopt);
  EXPECT_EQ(g_trouble.calls, 0);
}

TEST_F(FileCalls, FailuresAreTold) {
  const auto medium = opened();
  std::vector<uint8_t> bytes = numbered(3);
  g_trouble.error = EIO;
  EXPECT_EQ(medium->read(0, bytes).error(), "Input/output error");
  EXPECT_EQ(medium->write(0, bytes), "Input/output error");
  g_trouble.error = 0;
  g_trouble.most = 0;
  EXPECT_EQ(medium->write(0, bytes), "No space left on device") << "nothing was written, and no reason";
  g_trouble = {};
  EXPECT_EQ(medium->sync(), std::nullopt);
  EXPECT_EQ(g_trouble.syncs, 1);
  g_trouble.sync_error = EIO;
  EXPECT_EQ(medium->sync(), "Input/output error");
}

// The entry of a new file in its folder has to be on the disk, too.
TEST_F(FileCalls, TheFolderOfANewFileIsSynchronised) {
  g_trouble.sync_error = EIO;
  EXPECT_EQ(open_file_medium(path_, FileUse::Write).error(), "Input/output error");
  g_trouble = {};
  {
    const auto medium = opened();
    EXPECT_EQ(g_trouble.syncs, 1);
    ASSERT_EQ(medium->write(0, numbered(1)), std::nullopt);
  }
  opened();
  EXPECT_EQ(g_trouble.syncs, 1) << "a file that holds something is not new";
  opened(FileUse::Look);
  EXPECT_EQ(g_trouble.syncs, 1);
}

TEST_F(FileCalls, ANameWithoutAFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  EXPECT_TRUE(open_file_medium("bare.nv", FileUse::Write));
  fs::current_path(before);
  EXPECT_TRUE(fs::exists(folder_ / "bare.nv"));
}

// Files that are looked at while another run writes are read until two readings are equal.
TEST_F(FileCalls, ACopyThatCannotBeReadIsNone) {
  opened();
  g_trouble.error = EIO;
  EXPECT_EQ(open_file_medium(path_, FileUse::Look).error(), "Input/output error");
}

// Everybody may read the file of a unit, and its owner write it.
TEST_F(FileCalls, RightsOfANewFile) {
  const mode_t before = umask(0);
  opened();
  umask(before);
  struct stat status {};
  ASSERT_EQ(stat(path_.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
}

// The superuser takes the rights of somebody for a while, within a folder: those above it may be closed to others.
class AsSomebodyIn {
 public:
  explicit AsSomebodyIn(const fs::path& folder) : before_(fs::current_path()), root_(geteuid() == 0) {
    fs::current_path(folder);
    if (root_) root_ = seteuid(65'534) == 0;
  }
  ~AsSomebodyIn() {
    if (root_) {
      EXPECT_EQ(seteuid(0), 0);
    }
    fs::current_path(before_);
  }
  AsSomebodyIn(const AsSomebodyIn&) = delete;
  AsSomebodyIn& operator=(const AsSomebodyIn&) = delete;

 private:
  fs::path before_;
  bool root_;
};

TEST_F(FileCalls, WhoMayOnlyReadLooks) {
  opened();
  fs::permissions(folder_, fs::perms(0755));
  fs::permissions(path_, fs::perms(0444));
  const AsSomebodyIn somebody(folder_);
  EXPECT_TRUE(open_file_medium("./unit1.nv", FileUse::Look));
  EXPECT_EQ(open_file_medium("./unit1.nv", FileUse::Write).error(), "Permission denied");
}

// Then its entry cannot be synchronised.
TEST_F(FileCalls, AFolderThatCannotBeRead) {
  fs::permissions(folder_, fs::perms(0333));
  const AsSomebodyIn somebody(folder_);
  EXPECT_EQ(open_file_medium("./unit1.nv", FileUse::Write).error(), "Permission denied");
}

// A process may begin without its standard input: the file then has the number 0.
TEST_F(FileCalls, TheFileMayBeNumberZero) {
  const int before = dup(STDIN_FILENO);
  close(STDIN_FILENO);
  {
    const auto medium = opened();
    EXPECT_EQ(fcntl(STDIN_FILENO, F_GETFL) & O_ACCMODE, O_RDWR);
    EXPECT_EQ(medium->write(0, numbered(1)), std::nullopt);
  }
  EXPECT_EQ(fcntl(STDIN_FILENO, F_GETFL), -1) << "closed again";
  if (before >= 0) {
    dup2(before, STDIN_FILENO);
    close(before);
  }
}

TEST_F(FileCalls, IsNotHandedToOtherPrograms) {
  const int next = dup(STDIN_FILENO);
  close(next);
  const auto medium = opened();
  EXPECT_EQ(fcntl(next, F_GETFD) & FD_CLOEXEC, FD_CLOEXEC);
}

}  // namespace
}  // namespace ipos::runtime
