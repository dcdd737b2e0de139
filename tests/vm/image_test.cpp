// The image container: round trip, and that damaged files are refused with the right reason.
#include "vm/image/image.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace ipos::vm {
namespace {

Image sample() {
  Image image;
  image.unit = 1;
  image.code = {0x21, 5, 0x02};
  image.symbols = {{"H0", 0, 1}, {"TrCycl.ObjectNo", 420, 1}, {"buffer", 430, 10}};
  image.functions = {{"main", 0}, {"helper", 2}};
  image.files = {"A.IPC", "const.h"};
  image.lines = {{0, 0, 3, 5}, {2, 1, 70000, 1}};
  return image;
}

// Writes the checksum of the changed bytes anew.
void seal(std::vector<uint8_t>& bytes) {
  const uint32_t crc = crc32(std::span(bytes).first(bytes.size() - 4));
  for (size_t n = 0; n < 4; ++n) bytes[bytes.size() - 4 + n] = static_cast<uint8_t>(crc >> (8 * n));
}

ImageError error_of(const std::vector<uint8_t>& bytes) { return read_image(bytes).error; }

TEST(Image, Crc32IsTheStandardOne) {
  const std::string check = "123456789";  // the check value of CRC-32/ISO-HDLC
  EXPECT_EQ(crc32({reinterpret_cast<const uint8_t*>(check.data()), check.size()}), 0xCBF43926U);
}

TEST(Image, RoundTrip) {
  const std::vector<uint8_t> bytes = write_image(sample());
  const ImageResult back = read_image(bytes);
  ASSERT_EQ(back.error, ImageError::None);
  EXPECT_EQ(back.image, sample());
  EXPECT_EQ(write_image(back.image), bytes);
}

TEST(Image, OnlyCodeIsRequired) {
  Image image;
  image.unit = 4;
  image.code = {2};
  const std::vector<uint8_t> bytes = write_image(image);
  EXPECT_EQ(bytes.size(), 16U + 12U + 4U + 4U);
  EXPECT_EQ(read_image(bytes).image, image);
}

// One flipped bit anywhere is refused: magic, version or checksum.
TEST(Image, EveryFlippedBitIsRefused) {
  const std::vector<uint8_t> good = write_image(sample());
  size_t refused = 0;
  for (size_t byte = 0; byte < good.size(); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      std::vector<uint8_t> bad = good;
      bad[byte] = static_cast<uint8_t>(bad[byte] ^ (1 << bit));
      refused += error_of(bad) != ImageError::None;
    }
  EXPECT_EQ(refused, good.size() * 8);
}

TEST(Image, EveryTruncationIsRefused) {
  const std::vector<uint8_t> good = write_image(sample());
  for (size_t length = 0; length < good.size(); ++length)
    EXPECT_NE(error_of({good.begin(), good.begin() + static_cast<std::ptrdiff_t>(length)}), ImageError::None)
        << length;
}

// The same with a valid checksum: whatever is accepted must be usable; nothing may read outside (sanitizers).
TEST(Image, DamageUnderAValidChecksum) {
  const std::vector<uint8_t> good = write_image(sample());
  size_t accepted = 0;
  for (size_t byte = 0; byte + 4 < good.size(); ++byte)
    for (int bit = 0; bit < 8; ++bit) {
      std::vector<uint8_t> bad = good;
      bad[byte] = static_cast<uint8_t>(bad[byte] ^ (1 << bit));
      seal(bad);
      const ImageResult result = read_image(bad);
      if (result.error != ImageError::None) continue;
      ++accepted;
      EXPECT_EQ(write_image(result.image), bad) << byte;
    }
  EXPECT_GT(accepted, 0U);  // changed code words and names are a different, but whole image
}

TEST(Image, ReasonsOfRefusal) {
  EXPECT_EQ(error_of({}), ImageError::BadMagic);
  EXPECT_EQ(error_of({'I', 'P', 'X', '1'}), ImageError::TooShort);
  EXPECT_EQ(error_of(std::vector<uint8_t>(64, 0)), ImageError::BadMagic);

  std::vector<uint8_t> bytes = write_image(sample());
  bytes[4] = 2;
  seal(bytes);
  EXPECT_EQ(error_of(bytes), ImageError::BadVersion);

  bytes = write_image(sample());
  bytes[40] ^= 1;
  EXPECT_EQ(error_of(bytes), ImageError::BadChecksum);

  bytes = write_image(sample());
  bytes[12] = 9;  // nine sections
  seal(bytes);
  EXPECT_EQ(error_of(bytes), ImageError::BadSectionTable);

  bytes = write_image(sample());
  bytes[16] = 2;  // the code section says it is symbols: two of them
  seal(bytes);
  EXPECT_EQ(error_of(bytes), ImageError::BadSectionTable);

  Image image;
  image.code = {2};
  bytes = write_image(image);
  bytes[16] = 3;  // its only section says it is functions
  seal(bytes);
  EXPECT_EQ(error_of(bytes), ImageError::MissingCode);

  image = sample();
  image.functions[1].address = 99;
  EXPECT_EQ(error_of(write_image(image)), ImageError::BadFunctions);

  image = sample();
  image.lines[1].file = 2;
  EXPECT_EQ(error_of(write_image(image)), ImageError::BadLines);

  image = sample();
  image.symbols[0].count = 0;
  EXPECT_EQ(error_of(write_image(image)), ImageError::BadSymbols);
}

// A section that ends within a word, a name or a row is refused, each kind with its own reason. The table has three
// words for each section, the last of them the length.
TEST(Image, SectionsThatEndInTheMiddleAreRefused) {
  Image code, symbols, functions, lines;
  code.code = symbols.code = functions.code = lines.code = {2, 2};
  symbols.symbols = {{"abc", 420, 1}};
  functions.functions = {{"main", 0}};
  lines.files = {"a.IPC"};
  lines.lines = {{0, 0, 5, 3}};
  const struct {
    const Image& image;
    size_t sections;
    ImageError error;
  } rows[] = {{code, 1, ImageError::BadCode},
              {symbols, 2, ImageError::BadSymbols},
              {functions, 2, ImageError::BadFunctions},
              {lines, 2, ImageError::BadLines}};
  for (const auto& row : rows) {
    const std::vector<uint8_t> good = write_image(row.image);
    ASSERT_EQ(error_of(good), ImageError::None);
    const size_t length_at = 16 + 12 * (row.sections - 1) + 8;
    const size_t length = good[length_at];
    for (size_t less = 1; less < length; ++less) {
      std::vector<uint8_t> bytes = good;
      bytes.erase(bytes.end() - 4 - static_cast<std::ptrdiff_t>(less), bytes.end() - 4);
      bytes[length_at] = static_cast<uint8_t>(length - less);
      seal(bytes);
      // A word of code less is a shorter program; behind its name the list of files may be all.
      const bool ends_well = row.error == ImageError::BadCode    ? less % 4 == 0
                             : row.error == ImageError::BadLines ? less == 12
                                                                 : false;
      EXPECT_EQ(error_of(bytes), ends_well ? ImageError::None : row.error)
          << to_text(row.error) << " " << less;
    }
  }
}

// Reading stops in front of a name that is not whole: behind number, count and length of it, two bytes each.
TEST(Image, ACutNameIsWhereReadingStops) {
  Image image;
  image.code = {2};
  image.symbols = {{"abcdefgh", 420, 1}};
  const std::vector<uint8_t> good = write_image(image);
  constexpr size_t kOffsetAt = 16 + 12 + 4, kLengthAt = kOffsetAt + 4;
  for (size_t less = 1; less <= 8; ++less) {
    std::vector<uint8_t> bytes = good;
    bytes.erase(bytes.end() - 4 - static_cast<std::ptrdiff_t>(less), bytes.end() - 4);
    bytes[kLengthAt] = static_cast<uint8_t>(bytes[kLengthAt] - less);
    seal(bytes);
    const ImageResult result = read_image(bytes);
    EXPECT_EQ(result.error, ImageError::BadSymbols) << less;
    EXPECT_EQ(result.offset, bytes[kOffsetAt] + 6U) << less;
  }
}

// Whatever stands behind the last section belongs to none: refused, whatever its checksum says.
TEST(Image, BytesBehindTheLastSectionAreRefused) {
  for (size_t more = 1; more <= 64; ++more) {
    std::vector<uint8_t> bytes = write_image(sample());
    const size_t end = bytes.size() - 4;
    bytes.insert(bytes.end() - 4, more, uint8_t{0});
    seal(bytes);
    const ImageResult result = read_image(bytes);
    EXPECT_EQ(result.error, ImageError::BadSectionTable) << more;
    EXPECT_EQ(result.offset, end) << more;
  }
}

// The bytes of docs/reference/isa.md, written by hand, without the checksum.
TEST(Image, HasTheLayoutOfTheReference) {
  Image image;
  image.unit = 0xFF;
  image.code = {0x04030201, 0x08070605};
  image.symbols = {{"ab", 0x1211, 0x1413}};
  image.functions = {{"f", 1}};
  image.files = {"x", "yz"};
  image.lines = {{1, 1, 0x24232221, 0x2625}};
  const std::vector<uint8_t> wanted{
      'I',  'P',  'X',  '1',  1,    0,    0,    0,    0xFF, 0,    0,    0,    4, 0, 0,   0,    // head
      1,    0,    0,    0,    64,   0,    0,    0,    8,    0,    0,    0,                     // code
      2,    0,    0,    0,    72,   0,    0,    0,    8,    0,    0,    0,                     // symbols
      3,    0,    0,    0,    80,   0,    0,    0,    7,    0,    0,    0,                     // functions
      4,    0,    0,    0,    87,   0,    0,    0,    21,   0,    0,    0,                     // lines
      0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x07, 0x08, 0x11, 0x12, 0x13, 0x14, 2, 0, 'a', 'b',  // payloads
      1,    0,    0,    0,    1,    0,    'f',  2,    0,    1,    0,    'x',  2, 0, 'y', 'z',
      1,    0,    0,    0,    1,    0,    0x21, 0x22, 0x23, 0x24, 0x25, 0x26};
  const std::vector<uint8_t> bytes = write_image(image);
  EXPECT_EQ((std::vector<uint8_t>{bytes.begin(), bytes.end() - 4}), wanted);
  EXPECT_EQ(read_image(bytes).image, image);
}

// Where the trouble was seen: the first byte of the number or row that is wrong. What is changed is a number of four
// bytes; the sample has the sections code, symbols, functions and lines.
TEST(Image, RefusalsNameTheirPlace) {
  const std::vector<uint8_t> good = write_image(sample());
  const auto end = static_cast<uint32_t>(good.size() - 4);
  const auto word = [&](size_t at) { return good[at] | uint32_t{good[at + 1]} << 8; };
  const auto row = [](uint32_t section) { return 16 + 12 * section; };
  const struct {
    size_t at;
    uint32_t value;
    ImageError error;
    uint32_t offset;
  } rows[] = {
      {0, 0x31585048, ImageError::BadMagic, 0},
      {4, 0, ImageError::BadVersion, 4},
      {4, 2, ImageError::BadVersion, 4},
      {8, 256, ImageError::BadSectionTable, 8},
      {8, 0x0100'0001, ImageError::BadSectionTable, 8},
      {12, 5, ImageError::BadSectionTable, 12},
      {12, 0x8000'0000, ImageError::BadSectionTable, 12},
      {12, 3, ImageError::BadSectionTable, row(0)},  // so the payloads would begin where the fourth row is
      {row(0), 0, ImageError::BadSectionTable, row(0)},
      {row(1), 1, ImageError::BadSectionTable, row(1)},  // twice
      {row(2), 1, ImageError::BadSectionTable, row(2)},  // falling
      {row(3), 5, ImageError::BadSectionTable, row(3)},
      {row(3), UINT32_MAX, ImageError::BadSectionTable, row(3)},
      {row(0) + 4, word(row(0) + 4) - 1, ImageError::BadSectionTable, row(0)},  // overlapping
      {row(1) + 4, word(row(1) + 4) + 1, ImageError::BadSectionTable, row(1)},  // a gap
      {row(3) + 8, word(row(3) + 8) + 1, ImageError::BadSectionTable, row(3)},  // beyond the end
      {row(3) + 8, UINT32_MAX, ImageError::BadSectionTable, row(3)},
      {row(3) + 8, word(row(3) + 8) - 1, ImageError::BadSectionTable, end - 1},  // a byte is nobody's
  };
  for (const auto& change : rows) {
    std::vector<uint8_t> bytes = good;
    for (size_t n = 0; n < 4; ++n) bytes[change.at + n] = static_cast<uint8_t>(change.value >> (8 * n));
    seal(bytes);
    const ImageResult result = read_image(bytes);
    EXPECT_EQ(result.error, change.error) << change.at << " " << change.value;
    EXPECT_EQ(result.offset, change.offset) << change.at << " " << change.value;
    EXPECT_EQ(view_image(bytes).error, change.error) << change.at << " " << change.value;
  }
  std::vector<uint8_t> bytes = good;
  bytes.back() ^= 1;
  EXPECT_EQ(read_image(bytes).error, ImageError::BadChecksum);
  EXPECT_EQ(read_image(bytes).offset, end);
  EXPECT_EQ(read_image({good.begin(), good.begin() + 19}).offset, 19U) << "too short";
}

// Head and checksum alone are 20 bytes: whole, but for the code. With a byte less the file is too short.
TEST(Image, HeadAndChecksumAreTheLeast) {
  std::vector<uint8_t> bytes{'I', 'P', 'X', '1', 1, 0, 0, 0, 7, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
  seal(bytes);
  EXPECT_EQ(read_image(bytes).error, ImageError::MissingCode);
  EXPECT_EQ(read_image(bytes).offset, 16U);
  bytes[12] = 1;  // a section, for which there is no row
  seal(bytes);
  EXPECT_EQ(read_image(bytes).error, ImageError::BadSectionTable);
  EXPECT_EQ(read_image(bytes).offset, 12U);
  bytes.pop_back();
  EXPECT_EQ(read_image(bytes).error, ImageError::TooShort);
}

// Functions and lines are at words of the code, files are those of the list, lines rise or stand still.
TEST(Image, WhatPointsIntoTheCodePointsAtAWordOfIt) {
  for (uint32_t address = 0; address <= 5; ++address) {
    Image image = sample();  // of three words
    image.functions[1].address = address;
    EXPECT_EQ(error_of(write_image(image)), address < 3 ? ImageError::None : ImageError::BadFunctions)
        << address;
    image = sample();
    image.lines[1].address = address;
    EXPECT_EQ(error_of(write_image(image)), address < 3 ? ImageError::None : ImageError::BadLines) << address;
    image.lines[0].address = 1;
    EXPECT_EQ(error_of(write_image(image)),
              address == 1 || address == 2 ? ImageError::None : ImageError::BadLines)
        << address;
    image = sample();
    image.lines[0].file = static_cast<uint16_t>(address);
    EXPECT_EQ(error_of(write_image(image)), address < 2 ? ImageError::None : ImageError::BadLines) << address;
  }
}

// A text has two bytes for its length; what is longer is cut.
TEST(Image, TextsHaveAtMost65535Bytes) {
  for (const size_t length :
       {size_t{0}, size_t{255}, size_t{256}, size_t{65535}, size_t{65536}, size_t{70000}}) {
    Image image = sample();
    image.functions[0].name = std::string(length, 'f');
    const ImageResult back = read_image(write_image(image));
    ASSERT_EQ(back.error, ImageError::None) << length;
    EXPECT_EQ(back.image.functions[0].name, std::string(std::min(length, size_t{65535}), 'f'));
    EXPECT_EQ(back.image.functions[1].name, "helper");
  }
}

// Beyond the end every number is 0 and every text empty, and the reader says so for good.
TEST(Reader, GivesNothingBeyondItsBytes) {
  const std::vector<uint8_t> bytes{1, 2, 3, 4, 5};
  for (size_t length = 0; length <= bytes.size(); ++length) {
    const auto part = std::span(bytes).first(length);
    Reader words(part, 100);
    EXPECT_EQ(words.u32(), length == 0   ? 0U
                           : length == 1 ? 0x1U
                           : length == 2 ? 0x201U
                           : length == 3 ? 0x30201U
                                         : 0x4030201U);
    EXPECT_EQ(words.ok(), length >= 4) << length;
    EXPECT_EQ(words.at_end(), length == 4) << length;
    EXPECT_EQ(words.offset(), 100 + std::min<size_t>(length, 4)) << length;
    EXPECT_EQ(words.u8(), length == 5 ? 5U : 0U);
    EXPECT_EQ(words.ok(), length == 5) << length;
    EXPECT_EQ(words.at_end(), length == 5) << length;
  }
  const std::vector<uint8_t> text{2, 0, 'a', 'b', 'c'};
  for (size_t length = 0; length <= text.size(); ++length) {
    Reader in(std::span<const uint8_t>(text.data(), length));
    EXPECT_EQ(in.text(), length >= 4 ? "ab" : "") << length;
    EXPECT_EQ(in.ok(), length >= 4) << length;
    EXPECT_EQ(in.at_end(), length == 4) << length;
  }
}

TEST(Image, EveryErrorHasAText) {
  for (int n = 0; n <= static_cast<int>(ImageError::BadLines); ++n)
    EXPECT_STRNE(to_text(static_cast<ImageError>(n)), "");
}

}  // namespace
}  // namespace ipos::vm
