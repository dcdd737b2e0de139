// Bytes with parity errors as Windows gives them, in the marks that a terminal of Linux has.
#include "runtime/os_port/replaced_bytes.hpp"

#include <gtest/gtest.h>

#include "runtime/os_port/parity_marks.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

// What a port makes of a reading: bad bytes as capital B, good ones as g.
std::string quality(ReplacedBytes& replaced, const std::string& bytes, bool reported) {
  ParityMarks marks;
  std::string good, values;
  const std::string marked = replaced.mark(bytes, reported);
  EXPECT_LE(marked.size(), bytes.size() * ReplacedBytes::kLongestMark);
  for (const char c : marked)
    if (const auto byte = marks.push(static_cast<uint8_t>(c))) {
      good += byte->bad ? 'B' : 'g';
      values += static_cast<char>(byte->value);
    }
  EXPECT_EQ(values, bytes) << "each byte once, in order";
  return good;
}

const std::string kInPlace(1, static_cast<char>(ReplacedBytes::kReplacement));

TEST(ReplacedBytes, WithoutAReportAllAreGood) {
  ReplacedBytes replaced;
  std::string all;
  for (int value = 0; value < 256; ++value) all += static_cast<char>(value);
  EXPECT_EQ(quality(replaced, all, false), std::string(256, 'g'));
  EXPECT_EQ(quality(replaced, "", false), "");
}

TEST(ReplacedBytes, TheReplacedOnesAreBad) {
  ReplacedBytes replaced;
  EXPECT_EQ(quality(replaced, "\x02" + kInPlace + "\xFF" + kInPlace, true), "gBgB");
  EXPECT_EQ(quality(replaced, kInPlace, false), "g") << "the report was for those before";
}

// The driver reports an error, and has replaced nothing.
TEST(ReplacedBytes, ElseAllOfTheReadingAre) {
  ReplacedBytes replaced;
  EXPECT_EQ(quality(replaced, std::string("\x02\xFF\x00", 3), true), "BBB");
  EXPECT_EQ(quality(replaced, "abc", false), "ggg");
}

// The report came before its byte was read.
TEST(ReplacedBytes, AReportMayComeEarly) {
  ReplacedBytes replaced;
  EXPECT_EQ(quality(replaced, "ab", true), "BB");
  EXPECT_EQ(quality(replaced, "c" + kInPlace, false), "gB");
  EXPECT_EQ(quality(replaced, kInPlace, false), "g");
  EXPECT_EQ(quality(replaced, "", true), "");
  EXPECT_EQ(quality(replaced, kInPlace, false), "B");
}

// Of a telegram of MOVILINK or PROFIBUS no first byte: 02h, 1Dh (1053 1610 p. 18), 10h, 68h, A2h, DCh, E5h (DIN 19245).
TEST(ReplacedBytes, BeginNoTelegram) {
  for (const int start : {0x02, 0x1D, 0x10, 0x68, 0xA2, 0xDC, 0xE5}) EXPECT_NE(ReplacedBytes::kReplacement, start);
}

}  // namespace
}  // namespace ipos::tests
