// The table of the monitor: rows, marks, order and keys.
#include "tools/bus/monitor_table.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace ipos::tools {
namespace {

using runtime::kMillisecond;

class MonitorTableTest : public ::testing::Test {
 protected:
  void put(int64_t ms, uint32_t id, std::vector<uint8_t> bytes, const std::string& text = "") {
    table_.put(ms * kMillisecond, "sbus", id, fmt_id(id), bytes, text);
  }
  static std::string fmt_id(uint32_t id) {
    std::ostringstream out;
    out << std::hex << std::uppercase << id;
    return out.str();
  }
  std::vector<std::string> lines(size_t height = 0, size_t width = 200) {
    std::istringstream in(table_.draw(width, height, false));
    std::vector<std::string> all;
    for (std::string line; std::getline(in, line);) all.push_back(line);
    return all;
  }
  void type(const std::string& keys) {
    for (const char key : keys) EXPECT_TRUE(table_.press(key));
  }
  MonitorTable table_;
};

TEST_F(MonitorTableTest, ARowAnIdentifierWithItsChanges) {
  put(1000, 0x20B, {1, 2, 3});
  put(1020, 0x20B, {1, 9, 3}, "read 8318");
  const auto all = lines();
  ASSERT_EQ(all.size(), 3U) << "head, row, foot";
  EXPECT_NE(all[1].find("20B              2      20.0     0.020   01 [09] 03"), std::string::npos) << all[1];
  EXPECT_TRUE(all[1].ends_with("read 8318"));
  EXPECT_EQ(all[2], "2 telegrams, 1 of 1 rows, sorted by identifier");
}

// The text stands in one column behind the place of eight bytes, and further on where there are more.
TEST_F(MonitorTableTest, TextsStandBelowEachOther) {
  const size_t column = std::string("sbus     1                1         -     0.000  ").size() + 8 * 4 + 1;
  for (uint32_t count = 0; count <= 8; ++count) put(0, count, std::vector<uint8_t>(count, 0x11), "text");
  put(0, 9, std::vector<uint8_t>(12, 0x11), "text");
  const auto all = lines();
  for (size_t n = 0; n <= 8; ++n) EXPECT_EQ(all[n + 1].find("text"), column) << all[n + 1];
  EXPECT_GT(all[10].find("text"), column) << all[10];
}

TEST_F(MonitorTableTest, SortsByIdentifierCountAndLastChange) {
  put(0, 5, {0});
  put(1, 3, {0});
  put(2, 3, {0});
  put(3, 4, {0});
  const auto order = [&] {
    std::string ids;
    for (const std::string& line : lines())
      if (line.starts_with("sbus")) ids += line[9];
    return ids;
  };
  EXPECT_EQ(order(), "345");
  type("s");
  EXPECT_EQ(order(), "345") << "two of 3, equal ones by identifier";
  type("s");
  EXPECT_EQ(order(), "435");
  type("s");
  EXPECT_EQ(order(), "345");
}

TEST_F(MonitorTableTest, FiltersByWhatIsSeen) {
  put(0, 5, {0}, "PO SPEED");
  put(0, 6, {0}, "PI STATUS");
  type("/speed\n");
  ASSERT_EQ(lines().size(), 3U);
  EXPECT_TRUE(lines()[1].ends_with("PO SPEED"));
  EXPECT_TRUE(lines()[2].ends_with("filter /speed"));
  type("/\x1b");
  EXPECT_EQ(lines().size(), 4U) << "escape: without filter";
  type("/sq");
  ASSERT_EQ(lines().size(), 2U) << "no row has sq";
  EXPECT_EQ(lines()[1].substr(0, 9), "2 telegra") << "q is a letter of the filter here";
  type("\x7f");  // and each of the two keys takes one away
  EXPECT_EQ(lines().size(), 4U) << "both rows have an s";
  type("pxy\b\b");
  ASSERT_EQ(lines().size(), 3U);
  EXPECT_TRUE(lines()[1].ends_with("PO SPEED"));
  type("\b\b\b\b\x7f");
  EXPECT_EQ(lines().size(), 4U) << "there is nothing more to take away";
  type("\x01\t");
  EXPECT_EQ(lines().size(), 4U) << "control characters are no text";
}

TEST_F(MonitorTableTest, PausesWhileTelegramsGoOn) {
  put(0, 5, {0});
  type("p");
  put(1, 6, {0});
  EXPECT_EQ(lines().size(), 3U);
  EXPECT_NE(lines()[2].find("PAUSED"), std::string::npos);
  type("p");
  EXPECT_EQ(lines().size(), 4U);
  type("c");
  EXPECT_EQ(lines().size(), 2U);
  EXPECT_FALSE(table_.press('q'));
}

TEST_F(MonitorTableTest, FitsTheTerminal) {
  for (uint32_t id = 0; id < 50; ++id) put(id, id, {1, 2, 3, 4, 5, 6, 7, 8}, std::string(300, 'x'));
  const auto all = lines(10, 100);
  EXPECT_EQ(all.size(), 10U);
  for (const std::string& line : all) EXPECT_LE(line.size(), 100U);
}

}  // namespace
}  // namespace ipos::tools
