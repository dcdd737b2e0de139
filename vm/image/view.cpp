// The container of an image:
//
//   0  "IPX1"                    magic
//   4  u32 version               1
//   8  u32 unit                  row of stdlib/unit_types.def
//  12  u32 number of sections
//  16  sections: u32 kind, u32 offset, u32 size each, in rising order of offset, without gaps
//   .  payloads
//  -4  u32 CRC-32 over everything before it
#include "vm/image/view.hpp"

#include <array>

namespace ipos::vm {
namespace {

constexpr uint32_t kHeaderSize = 16;
constexpr uint32_t kSectionSize = 12;
constexpr uint32_t kChecksumSize = 4;

// By half bytes: a table of 64 bytes instead of 1 KiB, for the flash of small units.
constexpr auto kCrcTable = [] {
  std::array<uint32_t, 16> table{};
  for (uint32_t n = 0; n < table.size(); ++n) {
    uint32_t value = n;
    for (int bit = 0; bit < 4; ++bit) value = (value & 1) != 0 ? (value >> 1) ^ 0xEDB88320U : value >> 1;
    table[n] = value;
  }
  return table;
}();

ImageViewResult refuse(ImageError error, uint32_t offset) { return {error, offset, {}}; }

}  // namespace

uint32_t Reader::u8() {
  if (at_ >= bytes_.size()) {
    ok_ = false;
    return 0;
  }
  return bytes_[at_++];
}

uint32_t Reader::u16() {
  const uint32_t low = u8();
  return low | u8() << 8;
}

uint32_t Reader::u32() {
  const uint32_t low = u16();
  return low | u16() << 16;
}

std::string_view Reader::text() {
  const uint32_t length = u16();
  if (bytes_.size() - at_ < length) {
    ok_ = false;
    return {};
  }
  const std::string_view out(reinterpret_cast<const char*>(bytes_.data()) + at_, length);
  at_ += length;
  return out;
}

std::optional<SymbolView> read_symbol(Reader& in) {
  SymbolView symbol;
  symbol.variable = static_cast<uint16_t>(in.u16());
  symbol.count = static_cast<uint16_t>(in.u16());
  symbol.name = in.text();
  if (!in.ok() || symbol.count == 0) return std::nullopt;
  return symbol;
}

ImageViewResult view_image(std::span<const uint8_t> bytes) {
  Reader header(bytes);
  if (header.u32() != kImageMagic) return refuse(ImageError::BadMagic, 0);
  if (bytes.size() < kHeaderSize + kChecksumSize || bytes.size() > 0xFFFF'FFFFU)
    return refuse(ImageError::TooShort, static_cast<uint32_t>(bytes.size()));
  if (header.u32() != kImageVersion) return refuse(ImageError::BadVersion, 4);

  const auto payload = bytes.first(bytes.size() - kChecksumSize);
  const auto end = static_cast<uint32_t>(payload.size());
  ImageViewResult result;
  result.view.checksum = Reader(bytes.last(kChecksumSize), end).u32();
  if (result.view.checksum != crc32(payload)) return refuse(ImageError::BadChecksum, end);

  const uint32_t unit = header.u32();
  if (unit > 0xFF) return refuse(ImageError::BadSectionTable, 8);
  result.view.unit = static_cast<uint8_t>(unit);
  const uint32_t count = header.u32();
  if (count > kSections || end < kHeaderSize + count * kSectionSize)
    return refuse(ImageError::BadSectionTable, 12);

  uint32_t expected = kHeaderSize + count * kSectionSize;
  uint32_t last_kind = 0;
  bool has_code = false;
  for (uint32_t n = 0; n < count; ++n) {
    const uint32_t row = kHeaderSize + n * kSectionSize;
    const uint32_t kind = header.u32();
    const uint32_t offset = header.u32();
    const uint32_t size = header.u32();
    const bool in_file = offset == expected && size <= end - offset;
    if (!in_file || kind <= last_kind || kind > kSections) return refuse(ImageError::BadSectionTable, row);
    result.view.sections[kind - 1] = {offset, bytes.subspan(offset, size)};
    has_code = has_code || kind == static_cast<uint32_t>(Section::Code);
    last_kind = kind;
    expected += size;
  }
  if (expected != end) return refuse(ImageError::BadSectionTable, expected);
  if (!has_code) return refuse(ImageError::MissingCode, kHeaderSize);
  return result;
}

uint32_t crc32(std::span<const uint8_t> bytes) {
  uint32_t crc = 0xFFFFFFFFU;
  for (const uint8_t byte : bytes) {
    crc ^= byte;
    crc = kCrcTable[crc & 0xF] ^ (crc >> 4);
    crc = kCrcTable[crc & 0xF] ^ (crc >> 4);
  }
  return ~crc;
}

}  // namespace ipos::vm
