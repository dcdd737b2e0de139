// Files that verbs read and write: what replaces a file does so whole, and what is no file is refused at once.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <functional>

#include "tests/tools/command.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;
using tools::Failure;

class Files : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  size_t count() const {
    return static_cast<size_t>(std::distance(fs::directory_iterator(folder_.path()), {}));
  }
  TemporaryFolder folder_;
};

int exit_code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Failure& failure) {
    return failure.exit_code();
  }
  return 0;
}

TEST_F(Files, AReplacedFileKeepsItsModeAndItsLinks) {
  const std::string file = folder_.write("a", "old");
  chmod(file.c_str(), 0640);
  fs::create_symlink("a", path("link"));
  fs::create_symlink("link", path("link2"));
  tools::replace_file(path("link2"), "new");
  EXPECT_EQ(read_text(file), "new");
  EXPECT_TRUE(fs::is_symlink(path("link")));
  struct stat info {};
  ASSERT_EQ(stat(file.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 07777U, 0640U);
  fs::create_symlink("b", path("dangling"));
  tools::replace_file(path("dangling"), "made");
  EXPECT_EQ(read_text(path("b")), "made");
  EXPECT_EQ(count(), 5U) << "nothing is left beside them";
}

// A writer that was killed leaves its new file; the next one takes it away, but none that is being written.
TEST_F(Files, WhatKilledWritersLeftIsRemoved) {
  const pid_t gone = fork();
  if (gone == 0) _exit(0);
  waitpid(gone, nullptr, 0);
  const std::string dead = std::to_string(gone), own = std::to_string(getpid());
  folder_.write("a", "old");
  folder_.write(".a." + dead + ".0.tmp", "half");
  folder_.write(".a." + dead + ".1.tmp", "half");
  for (const std::string& other : std::vector<std::string>{".a." + own + ".7.tmp", ".b." + dead + ".0.tmp", ".a." + dead + "x.tmp",
                                  ".a..tmp", ".a.b." + dead + ".0.tmp", ".a." + dead + ".0.tmp~"})
    folder_.write(other, "of others");
  tools::replace_file(path("a"), "new");
  EXPECT_EQ(read_text(path("a")), "new");
  EXPECT_FALSE(fs::exists(path(".a." + dead + ".0.tmp")));
  EXPECT_FALSE(fs::exists(path(".a." + dead + ".1.tmp")));
  EXPECT_EQ(count(), 7U);
}

TEST_F(Files, NamesWithControlCharactersAreRefused) {
  for (const char* name : {"a\x1b[2J", "a\nb", "a\rb", "a\x9b"}) {
    folder_.write(name, "x");
    EXPECT_EQ(exit_code_of([&] { tools::read_file(path(name)); }), 66);
    EXPECT_FALSE(tools::try_read_file(path(name)));
  }
  folder_.write("Gr\xf6sse", "x");
  EXPECT_EQ(tools::read_file(path("Gr\xf6sse")), "x");
}

// As on a full disk: the file may not grow beyond a limit.
TEST_F(Files, AFullDiskLeavesTheOldFile) {
  const std::string file = folder_.write("a", "old");
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto on_limit = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1000, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const int code = exit_code_of([&] { tools::replace_file(file, std::string(5000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, on_limit);
  EXPECT_EQ(code, 74);
  EXPECT_EQ(read_text(file), "old");
  EXPECT_EQ(count(), 1U);
}

TEST_F(Files, OutputsThatCannotBe) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_symlink("loop", path("loop"));
  for (const std::string& name : {path("pipe"), path("loop"), path("no/where"), folder_.path().string(),
                                  std::string("/dev/full")}) {
    EXPECT_EQ(exit_code_of([&] { tools::replace_file(name, "x"); }), 74) << name;
    if (name == "/dev/full") continue;  // which can be opened
    EXPECT_EQ(exit_code_of([&] { tools::check_output(name); }), 74) << name;
  }
  tools::replace_file("/dev/null", "x");
  EXPECT_EQ(count(), 2U);
}

TEST_F(Files, AnInputIsNoOutput) {
  const std::string file = folder_.write("a", "old");
  fs::create_hard_link(file, path("b"));
  EXPECT_EQ(tools::read_file(file), "old");
  for (const std::string& name : {file, path("b")}) {
    EXPECT_EQ(exit_code_of([&] { tools::check_output(name); }), 64);
    EXPECT_EQ(exit_code_of([&] { tools::replace_file(name, "new"); }), 64);
    EXPECT_EQ(exit_code_of([&] { tools::LogOutput log(name); }), 64);
  }
  EXPECT_EQ(read_text(file), "old");
  tools::rewrite_file(file, "formatted");
  EXPECT_EQ(read_text(file), "formatted");
}

TEST_F(Files, InputsThatCannotBe) {
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  fs::create_symlink("loop", path("loop"));
  folder_.write("large", "");
  ASSERT_EQ(truncate(path("large").c_str(), off_t{3} << 30), 0);
  for (const std::string& name :
       {path("pipe"), path("loop"), path("large"), path("none"), folder_.path().string(),
        std::string("/dev/zero"), std::string("/dev/tty")}) {
    EXPECT_EQ(exit_code_of([&] { tools::read_file(name); }), 66) << name;
    EXPECT_FALSE(tools::load_file(name)) << name;
    EXPECT_TRUE(tools::unreadable(name)) << name;
  }
}

}  // namespace
}  // namespace ipos::tests
