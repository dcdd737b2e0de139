// The image container: round trip, and that damaged files are refused with the right reason.
#include "vm/image/image.hpp"

#include <gtest/gtest.h>

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

TEST(Image, EveryErrorHasAText) {
  for (int n = 0; n <= static_cast<int>(ImageError::BadLines); ++n)
    EXPECT_STRNE(to_text(static_cast<ImageError>(n)), "");
}

}  // namespace
}  // namespace ipos::vm
