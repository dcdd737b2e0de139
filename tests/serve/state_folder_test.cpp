// The small files of the user's state folder: who can read them, and whose are believed.
#include "tools/serve/state_folder.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;

class StateFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "ipos-state-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    place_ = name;
    setenv("XDG_STATE_HOME", (place_ / "state").c_str(), 1);
  }
  void TearDown() override {
    unsetenv("XDG_STATE_HOME");
    fs::remove_all(place_);
  }
  static unsigned mode(const fs::path& path) {
    struct stat about {};
    return stat(path.c_str(), &about) == 0 ? about.st_mode & 0777U : 0;
  }
  fs::path place_;
};

TEST_F(StateFolder, OnlyTheUserReadsWhatIsKept) {
  umask(0);
  ASSERT_TRUE(write_state("token-a", "one"));
  ASSERT_TRUE(write_state("token-a", "two"));
  const fs::path folder = place_ / "state" / "ipos";
  EXPECT_EQ(state_folder(), folder);
  EXPECT_EQ(mode(folder), 0700U);
  EXPECT_EQ(mode(folder / "token-a"), 0600U);
  EXPECT_EQ(read_state("token-a"), "two");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
      << "nothing is left beside";
  remove_state("token-a");
  EXPECT_FALSE(read_state("token-a"));
}

TEST_F(StateFolder, WhatOthersCouldHaveWrittenIsNotBelieved) {
  ASSERT_TRUE(write_state("open", "text"));
  chmod((state_folder() / "open").c_str(), 0644);
  EXPECT_FALSE(read_state("open"));
  ASSERT_TRUE(write_state("real", "text"));
  ASSERT_EQ(symlink("real", (state_folder() / "link").c_str()), 0);
  EXPECT_FALSE(read_state("link"));
  ASSERT_EQ(mkfifo((state_folder() / "pipe").c_str(), 0600), 0);
  EXPECT_FALSE(read_state("pipe")) << "and it does not wait for somebody who writes";
  // 512 KiB are read (ours). What is longer is not written, so that nothing is kept that would not come back; a file that
  // somebody else has made so long is not read.
  for (const size_t size : {524'287U, 524'288U, 524'289U, 600'000U}) {
    const std::string text(size, 'x');
    ASSERT_TRUE(write_state("large", "small"));
    EXPECT_EQ(write_state("large", text), size <= 524'288) << size;
    EXPECT_EQ(read_state("large"), size <= 524'288 ? text : "small") << size;
    std::ofstream(state_folder() / "large") << text;
    EXPECT_EQ(read_state("large").has_value(), size <= 524'288) << size;
  }
}

TEST_F(StateFolder, ALinkInThePlaceOfAFileIsReplacedAndNotFollowed) {
  const fs::path other = place_ / "other";
  std::ofstream(other) << "mine";
  ASSERT_FALSE(state_folder().empty());
  fs::create_symlink(other, state_folder() / "token-a");
  ASSERT_TRUE(write_state("token-a", "secret"));
  std::string text;
  std::ifstream(other) >> text;
  EXPECT_EQ(text, "mine");
  EXPECT_EQ(read_state("token-a"), "secret");
}

TEST_F(StateFolder, ARelativeNameInTheVariableIsIgnored) {
  setenv("XDG_STATE_HOME", "here", 1);
  const std::string before = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
  setenv("HOME", place_.c_str(), 1);
  EXPECT_EQ(state_folder(), place_ / ".local" / "state" / "ipos");
  setenv("HOME", before.c_str(), 1);
}

TEST_F(StateFolder, APlaceThatCannotBeMadeIsNone) {
  std::ofstream(place_ / "state") << "a file";
  EXPECT_EQ(state_folder(), fs::path());
  EXPECT_FALSE(write_state("a", "b"));
  EXPECT_FALSE(read_state("a"));
}

TEST_F(StateFolder, NamesTellPortsApart) {
  const std::string one = state_name("drive", "/dev/ttyUSB0 1");
  EXPECT_EQ(one.find('/'), std::string::npos);
  EXPECT_EQ(one, state_name("drive", "/dev/ttyUSB0 1"));
  EXPECT_NE(one, state_name("drive", "/dev/ttyUSB0_1"));
  // The last 40 characters, and FNV-1a of 64 bits over all (isthe.com/chongo/tech/comp/fnv: "foobar" is 85944171f73967e8).
  EXPECT_EQ(state_name("drive", "foobar"), "drive-foobar-85944171f73967e8");
  EXPECT_EQ(state_name("drive", std::string(5000, '/')).size(), 5 + 1 + 40 + 1 + 16U);
}

}  // namespace
}  // namespace ipos::tools::serve
