// Reader and writer of the .ipx container.
//
//   0  "IPX1"                    magic
//   4  u32 version               1
//   8  u32 unit                  row of stdlib/unit_types.def
//  12  u32 number of sections
//  16  sections: u32 kind, u32 offset, u32 size each, in rising order of offset, without gaps
//   .  payloads
//  -4  u32 CRC-32 over everything before it
//
// Text is stored as u16 length and bytes. Numbers are little endian.
#include "vm/image/image.hpp"

#include <array>
#include <cstring>

namespace ipos::vm {
namespace {

constexpr uint32_t kMagic = 0x31585049;  // "IPX1"
constexpr uint32_t kHeaderSize = 16;
constexpr uint32_t kSectionSize = 12;
constexpr uint32_t kChecksumSize = 4;

enum Section : uint32_t { kCode = 1, kSymbols = 2, kFunctions = 3, kLines = 4 };

constexpr auto kCrcTable = [] {
  std::array<uint32_t, 256> table{};
  for (uint32_t n = 0; n < table.size(); ++n) {
    uint32_t value = n;
    for (int bit = 0; bit < 8; ++bit) value = (value & 1) != 0 ? (value >> 1) ^ 0xEDB88320U : value >> 1;
    table[n] = value;
  }
  return table;
}();

class Writer {
 public:
  void u8(uint32_t v) { bytes_.push_back(static_cast<uint8_t>(v)); }
  void u16(uint32_t v) { u8(v), u8(v >> 8); }
  void u32(uint32_t v) { u16(v), u16(v >> 16); }
  void text(const std::string& s) {
    const std::string cut = s.substr(0, 0xFFFF);
    u16(static_cast<uint32_t>(cut.size()));
    bytes_.insert(bytes_.end(), cut.begin(), cut.end());
  }
  void append(const Writer& other) { bytes_.insert(bytes_.end(), other.bytes_.begin(), other.bytes_.end()); }
  uint32_t size() const { return static_cast<uint32_t>(bytes_.size()); }
  std::vector<uint8_t>& bytes() { return bytes_; }

 private:
  std::vector<uint8_t> bytes_;
};

// Reads without ever leaving its bytes: beyond the end all reads give 0 and ok() is false.
class Reader {
 public:
  Reader(std::span<const uint8_t> bytes, uint32_t base) : bytes_(bytes), base_(base) {}
  uint32_t u8() {
    if (at_ >= bytes_.size()) {
      ok_ = false;
      return 0;
    }
    return bytes_[at_++];
  }
  uint32_t u16() {
    const uint32_t low = u8();
    return low | u8() << 8;
  }
  uint32_t u32() {
    const uint32_t low = u16();
    return low | u16() << 16;
  }
  std::string text() {
    const uint32_t length = u16();
    if (bytes_.size() - at_ < length) {
      ok_ = false;
      return {};
    }
    std::string out(reinterpret_cast<const char*>(bytes_.data()) + at_, length);
    at_ += length;
    return out;
  }
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && at_ == bytes_.size(); }
  uint32_t offset() const { return base_ + static_cast<uint32_t>(at_); }

 private:
  std::span<const uint8_t> bytes_;
  uint32_t base_;
  size_t at_ = 0;
  bool ok_ = true;
};

Writer symbols_section(const Image& image) {
  Writer out;
  for (const Symbol& symbol : image.symbols) {
    out.u16(symbol.variable);
    out.u16(symbol.count);
    out.text(symbol.name);
  }
  return out;
}

Writer functions_section(const Image& image) {
  Writer out;
  for (const FunctionEntry& function : image.functions) {
    out.u32(function.address);
    out.text(function.name);
  }
  return out;
}

Writer lines_section(const Image& image) {
  Writer out;
  out.u16(static_cast<uint32_t>(image.files.size()));
  for (const std::string& file : image.files) out.text(file);
  for (const LineEntry& entry : image.lines) {
    out.u32(entry.address);
    out.u16(entry.file);
    out.u32(entry.line);
    out.u16(entry.column);
  }
  return out;
}

bool read_code(Reader& in, Image& image) {
  while (!in.at_end()) {
    const uint32_t word = in.u32();
    if (!in.ok()) return false;
    image.code.push_back(word);
  }
  return true;
}

bool read_symbols(Reader& in, Image& image) {
  while (!in.at_end()) {
    Symbol symbol;
    symbol.variable = static_cast<uint16_t>(in.u16());
    symbol.count = static_cast<uint16_t>(in.u16());
    symbol.name = in.text();
    if (!in.ok() || symbol.count == 0) return false;
    image.symbols.push_back(std::move(symbol));
  }
  return true;
}

bool read_functions(Reader& in, Image& image) {
  while (!in.at_end()) {
    FunctionEntry function;
    function.address = in.u32();
    function.name = in.text();
    if (!in.ok() || function.address >= image.code.size()) return false;
    image.functions.push_back(std::move(function));
  }
  return true;
}

bool read_lines(Reader& in, Image& image) {
  const uint32_t files = in.u16();
  for (uint32_t n = 0; n < files && in.ok(); ++n) image.files.push_back(in.text());
  while (in.ok() && !in.at_end()) {
    LineEntry entry;
    entry.address = in.u32();
    entry.file = static_cast<uint16_t>(in.u16());
    entry.line = in.u32();
    entry.column = static_cast<uint16_t>(in.u16());
    const bool rising = image.lines.empty() || image.lines.back().address <= entry.address;
    if (!in.ok() || entry.file >= files || entry.address >= image.code.size() || !rising) return false;
    image.lines.push_back(entry);
  }
  return in.ok();
}

struct SectionReader {
  uint32_t kind;
  ImageError error;
  bool (*read)(Reader&, Image&);
};
// The code comes first: the other sections are checked against it.
constexpr SectionReader kSections[] = {{kCode, ImageError::BadCode, read_code},
                                       {kSymbols, ImageError::BadSymbols, read_symbols},
                                       {kFunctions, ImageError::BadFunctions, read_functions},
                                       {kLines, ImageError::BadLines, read_lines}};

struct Place {
  uint32_t kind;
  uint32_t offset;
  uint32_t size;
};

ImageResult refuse(ImageError error, uint32_t offset) { return {error, offset, {}}; }

}  // namespace

uint32_t crc32(std::span<const uint8_t> bytes) {
  uint32_t crc = 0xFFFFFFFFU;
  for (const uint8_t byte : bytes) crc = kCrcTable[(crc ^ byte) & 0xFF] ^ (crc >> 8);
  return ~crc;
}

std::vector<uint8_t> write_image(const Image& image) {
  std::vector<std::pair<uint32_t, Writer>> sections;
  Writer code;
  for (const uint32_t word : image.code) code.u32(word);
  sections.emplace_back(kCode, std::move(code));
  if (!image.symbols.empty()) sections.emplace_back(kSymbols, symbols_section(image));
  if (!image.functions.empty()) sections.emplace_back(kFunctions, functions_section(image));
  if (!image.files.empty()) sections.emplace_back(kLines, lines_section(image));

  Writer out;
  out.u32(kMagic);
  out.u32(kImageVersion);
  out.u32(image.unit);
  out.u32(static_cast<uint32_t>(sections.size()));
  uint32_t offset = kHeaderSize + kSectionSize * static_cast<uint32_t>(sections.size());
  for (const auto& [kind, payload] : sections) {
    out.u32(kind);
    out.u32(offset);
    out.u32(payload.size());
    offset += payload.size();
  }
  for (const auto& [kind, payload] : sections) out.append(payload);
  out.u32(crc32(out.bytes()));
  return std::move(out.bytes());
}

ImageResult read_image(std::span<const uint8_t> bytes) {
  Reader header(bytes, 0);
  if (header.u32() != kMagic) return refuse(ImageError::BadMagic, 0);
  if (bytes.size() < kHeaderSize + kChecksumSize || bytes.size() > 0xFFFF'FFFFU)
    return refuse(ImageError::TooShort, static_cast<uint32_t>(bytes.size()));
  if (header.u32() != kImageVersion) return refuse(ImageError::BadVersion, 4);

  const auto payload = bytes.first(bytes.size() - kChecksumSize);
  const auto end = static_cast<uint32_t>(payload.size());
  Reader trailer(bytes.last(kChecksumSize), end);
  if (trailer.u32() != crc32(payload)) return refuse(ImageError::BadChecksum, end);

  ImageResult result;
  const uint32_t unit = header.u32();
  if (unit > 0xFF) return refuse(ImageError::BadSectionTable, 8);
  result.image.unit = static_cast<uint8_t>(unit);
  const uint32_t count = header.u32();
  if (count > std::size(kSections) || end < kHeaderSize + count * kSectionSize)
    return refuse(ImageError::BadSectionTable, 12);

  std::vector<Place> places;
  uint32_t expected = kHeaderSize + count * kSectionSize;
  for (uint32_t n = 0; n < count; ++n) {
    const uint32_t row = kHeaderSize + n * kSectionSize;
    Place place{};
    place.kind = header.u32();
    place.offset = header.u32();
    place.size = header.u32();
    const bool in_file = place.offset == expected && place.size <= end - place.offset;
    const bool ordered = places.empty() || places.back().kind < place.kind;
    if (!in_file || !ordered || place.kind > kLines || place.kind == 0)
      return refuse(ImageError::BadSectionTable, row);
    expected += place.size;
    places.push_back(place);
  }
  if (expected != end) return refuse(ImageError::BadSectionTable, expected);
  if (places.empty() || places.front().kind != kCode) return refuse(ImageError::MissingCode, kHeaderSize);

  for (const Place& place : places) {
    Reader in(bytes.subspan(place.offset, place.size), place.offset);
    const SectionReader& section = kSections[place.kind - 1];
    if (!section.read(in, result.image)) return refuse(section.error, in.offset());
  }
  return result;
}

const char* to_text(ImageError error) {
  switch (error) {
    case ImageError::None: return "no error";
    case ImageError::TooShort: return "the file is too short for an ipos image";
    case ImageError::BadMagic: return "the file is not an ipos image";
    case ImageError::BadVersion: return "the image has a version this ipos does not know";
    case ImageError::BadChecksum: return "the checksum is wrong: the image is damaged";
    case ImageError::BadSectionTable: return "the section table is damaged";
    case ImageError::MissingCode: return "the image has no code";
    case ImageError::BadCode: return "the code is not a whole number of words";
    case ImageError::BadSymbols: return "the symbol table is damaged";
    case ImageError::BadFunctions: return "the function table is damaged";
    case ImageError::BadLines: return "the line table is damaged";
  }
  return "";
}

}  // namespace ipos::vm
