// Archives of strangers: what is right is unpacked, what is damaged or leads elsewhere is refused with its reason.
#include "runtime/fmi_import/archive.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <fstream>
#include <sstream>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::fmi_import {
namespace {

using tests::contains;

std::string little(uint64_t value, size_t size) {
  std::string bytes;
  for (size_t n = 0; n < size; ++n) bytes += static_cast<char>(value >> (8 * n));
  return bytes;
}

// Archives byte by byte, after APPNOTE.TXT 4.3; what a test changes it changes here.
struct File {
  std::string name;
  std::string data;
  uint16_t method = 0;
  uint16_t flags = 0;
  std::optional<uint32_t> size{};
  std::optional<uint32_t> crc{};
  std::optional<uint32_t> offset{};
};

std::string zip(const std::vector<File>& files, std::string_view comment = "", std::optional<uint32_t> directory_at = {}) {
  std::string bytes, directory;
  for (const File& file : files) {
    const uint32_t crc = file.crc.value_or(
        static_cast<uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(file.data.data()), static_cast<uInt>(file.data.size()))));
    const auto size = static_cast<uint32_t>(file.data.size());
    const std::string head = little(20, 2) + little(file.flags, 2) + little(file.method, 2) + little(0, 4) + little(crc, 4) +
                             little(size, 4) + little(file.size.value_or(size), 4) + little(file.name.size(), 2) + little(0, 2);
    directory += "PK\1\2" + little(20, 2) + head + little(0, 2) + little(0, 2) + little(0, 2) + little(0, 4) +
                 little(file.offset.value_or(static_cast<uint32_t>(bytes.size())), 4) + file.name;
    bytes += "PK\3\4" + head + file.name + file.data;
  }
  const auto at = static_cast<uint32_t>(bytes.size());
  return bytes + directory + "PK\5\6" + little(0, 4) + little(files.size(), 2) + little(files.size(), 2) +
         little(directory.size(), 4) + little(directory_at.value_or(at), 4) + little(comment.size(), 2) + std::string(comment);
}

std::string refusal(const std::string& bytes) {
  const auto archive = Archive::open(bytes);
  if (!archive) return archive.error();
  const auto read = archive->read("a", 1000);
  return read ? "" : read.error();
}

TEST(FmuArchive, StoredFilesComeBack) {
  const auto archive = Archive::open(zip({{"a", "some bytes"}, {"f/", ""}, {"f/b", std::string("\0\1\2", 3)}}, "a comment PK\5\6"));
  ASSERT_TRUE(archive) << archive.error();
  EXPECT_EQ(archive->read("a", 100), "some bytes");
  EXPECT_EQ(archive->read("f/b", 100), std::string("\0\1\2", 3));
  EXPECT_TRUE(archive->has("f/b"));
  EXPECT_FALSE(archive->has("f/"));
  EXPECT_EQ(archive->read("c", 100).error(), "has no c");
  EXPECT_TRUE(contains(archive->read("a", 9).error(), "more than"));
}

// Packed by CMake, which deflates.
TEST(FmuArchive, DeflatedFilesComeBack) {
  std::ifstream in(IPOS_FMUS "/spring2.fmu", std::ios::binary);
  const auto archive = Archive::open(std::string(std::istreambuf_iterator<char>(in), {}));
  ASSERT_TRUE(archive) << archive.error();
  EXPECT_EQ(*archive->read("modelDescription.xml", 100'000), tests::read_text(IPOS_FMUS "/spring2/modelDescription.xml"));
  const tests::TemporaryFolder folder;
  ASSERT_TRUE(archive->unpack("resources/", folder.path()));
  EXPECT_EQ(tests::read_text(folder.path() / "resources" / "number.txt"), "42.5\n");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "binaries"));
  EXPECT_FALSE(archive->unpack("resources/", folder.path()));  // nothing is written over
}

TEST(FmuArchive, WhatLeadsElsewhereIsRefused) {
  for (const char* name : {"/etc/passwd", "../a", "a/../../b", "a/..", "..", "c:a", "c:\\a", "a\\..\\b", "./a", "a//b", "a\nb", ""})
    EXPECT_EQ(refusal(zip({{name, "x"}})), "has a file whose name leads out of its folder") << name;
  EXPECT_EQ(refusal(zip({{std::string("a\0b", 3), "x"}})), "has a file whose name leads out of its folder");
  EXPECT_EQ(refusal(zip({{"..a", "x"}, {"a", "x"}, {"b/...", "x"}})), "");
}

TEST(FmuArchive, WhatIsDamagedIsRefused) {
  EXPECT_EQ(refusal(""), "is no zip archive");
  EXPECT_EQ(refusal("PK\5\6"), "is no zip archive");
  const std::string good = zip({{"a", "some bytes"}});
  EXPECT_EQ(refusal(good.substr(0, good.size() - 1)), "is no zip archive");
  EXPECT_EQ(refusal(zip({{"a", "x"}}, "", 5)), "has a damaged directory");
  EXPECT_EQ(refusal(zip({{"a", "x"}}, "", 1'000'000)), "has a damaged directory");
  EXPECT_EQ(refusal(zip({{"a", "x", 0, 0, {}, 7}})), "'a' is damaged");                 // its sum
  EXPECT_EQ(refusal(zip({{"a", "x", 0, 0, 2}})), "'a' is damaged");                     // its size
  EXPECT_EQ(refusal(zip({{"a", "x", 0, 0, {}, {}, 1'000'000}})), "'a' is damaged");     // its place
  EXPECT_EQ(refusal(zip({{"a", "no deflated bytes", 8}})), "'a' is damaged");
  EXPECT_EQ(refusal(zip({{"a", "x", 12}})), "has 'a' packed in a way that ipos does not read");
  EXPECT_EQ(refusal(zip({{"a", "x", 0, 1}})), "is encrypted");
  EXPECT_EQ(refusal(zip({{"a", "x"}, {"a", "y"}})), "has two files 'a'");
  EXPECT_TRUE(contains(refusal(zip({{"a", "x", 8, 0, 0xFFFFFFF0U}})), "MB unpacked"));
  EXPECT_EQ(refusal(zip({{"a", "x"}}, "", UINT32_MAX)), "is a zip64 archive, which ipos does not read");
}

// Each byte changed and each length cut: never more than an error.
TEST(FmuArchive, AnyDamageIsOnlyAnError) {
  const std::string good = zip({{"a", "some bytes"}, {"f/b", "more"}});
  for (size_t at = 0; at < good.size(); ++at)
    for (const int changed : {0x00, 0x01, 0x7F, 0x80, 0xFF}) {
      std::string bytes = good;
      bytes[at] = static_cast<char>(changed);
      refusal(bytes);
      refusal(good.substr(at));
      refusal(good.substr(0, at));
    }
}

}  // namespace
}  // namespace ipos::fmi_import
