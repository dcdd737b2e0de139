// The copy that somebody gets who only looks at a file, while another run may be writing it.
#include "runtime/nv_memory/medium/file_copy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ipos::runtime {
namespace {

using Bytes = std::vector<uint8_t>;

// Another run stores in it between the first readings: at reading n the file holds n, until it has `stores`.
class BusyFile final : public NvMedium {
 public:
  explicit BusyFile(uint8_t stores) : stores_(stores) {}

  tl::expected<size_t, std::string> read(uint64_t offset, std::span<uint8_t> out) override {
    EXPECT_EQ(offset, 0U) << "it is read from its beginning";
    EXPECT_GT(out.size(), 3U);
    if (unreadable_at == ++readings) return tl::unexpected(std::string("input/output error"));
    std::fill_n(out.begin(), 3, static_cast<uint8_t>(std::min<int>(readings, stores_)));
    return 3;
  }
  std::optional<std::string> write(uint64_t, std::span<const uint8_t>) override {
    ADD_FAILURE() << "who looks writes nothing";
    return std::nullopt;
  }
  std::optional<std::string> sync() override { return write(0, {}); }

  int readings = 0;
  int unreadable_at = 0;

 private:
  uint8_t stores_;
};

Bytes content(NvMedium& medium, uint64_t offset = 0, size_t most = 100) {
  Bytes bytes(most);
  const auto count = medium.read(offset, bytes);
  EXPECT_TRUE(count.has_value());
  bytes.resize(count.value_or(0));
  return bytes;
}

TEST(FileCopy, IsOfAStateThatWasReadTwice) {
  for (const auto& [stores, readings] : {std::pair<uint8_t, int>{1, 2}, {2, 3}, {7, 8}, {99, 100}}) {
    BusyFile file(stores);
    const auto copy = copy_of(file);
    ASSERT_TRUE(copy.has_value()) << copy.error();
    EXPECT_EQ(content(**copy), Bytes(3, stores));
    EXPECT_EQ(file.readings, readings);
  }
}

TEST(FileCopy, GivesUpAFileThatIsWrittenAllTheTime) {
  BusyFile file(255);
  const auto copy = copy_of(file);
  ASSERT_FALSE(copy.has_value());
  EXPECT_EQ(copy.error(), "another run is writing it all the time");
  EXPECT_EQ(file.readings, 100);
}

TEST(FileCopy, TellsWhyAFileCannotBeRead) {
  for (const int reading : {1, 2}) {
    BusyFile file(1);
    file.unreadable_at = reading;
    const auto copy = copy_of(file);
    ASSERT_FALSE(copy.has_value()) << reading;
    EXPECT_EQ(copy.error(), "input/output error");
  }
}

TEST(FileCopy, TakesWhatIsWrittenForItself) {
  BusyFile file(4);
  const auto made = copy_of(file);
  ASSERT_TRUE(made.has_value());
  NvMedium& copy = **made;
  EXPECT_EQ(content(copy, 1), Bytes(2, 4));
  EXPECT_EQ(content(copy, 1, 1), Bytes(1, 4));
  EXPECT_EQ(content(copy, 3), Bytes());
  EXPECT_EQ(content(copy, 4), Bytes());
  EXPECT_EQ(copy.write(1, Bytes{8}), std::nullopt);
  EXPECT_EQ(content(copy), (Bytes{4, 8, 4}));
  EXPECT_EQ(copy.write(2, Bytes{5, 6}), std::nullopt);
  EXPECT_EQ(content(copy), (Bytes{4, 8, 5, 6}));
  EXPECT_EQ(copy.write(6, Bytes{9}), std::nullopt);
  EXPECT_EQ(content(copy), (Bytes{4, 8, 5, 6, 0, 0, 9}));
  EXPECT_EQ(copy.sync(), std::nullopt);
}

TEST(FileCopy, OfAFileThatIsNotThereIsEmpty) {
  const auto copy = copy_of_nothing();
  EXPECT_EQ(content(*copy), Bytes());
  EXPECT_EQ(copy->write(0, Bytes{1, 2}), std::nullopt);
  EXPECT_EQ(content(*copy), (Bytes{1, 2}));
}

}  // namespace
}  // namespace ipos::runtime
