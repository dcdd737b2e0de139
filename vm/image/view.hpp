// An image (.ipx, layout in docs/reference/isa.md) as it lies in memory: nothing is copied and nothing allocated, so it
// can stay in the flash of a microcontroller. vm/image/image.hpp makes values of it where there is a heap.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace ipos::vm {

inline constexpr uint32_t kImageVersion = 1;
inline constexpr uint32_t kImageMagic = 0x31585049;  // "IPX1"

// Kinds of sections; every image has code.
enum class Section : uint8_t { Code = 1, Symbols = 2, Functions = 3, Lines = 4 };
inline constexpr uint32_t kSections = 4;

// Why an image was refused.
enum class ImageError : uint8_t {
  None,
  TooShort,         // shorter than header and checksum
  BadMagic,         // not an ipos image
  BadVersion,       // written by a newer version
  BadChecksum,      // CRC-32 differs: the file was damaged
  BadSectionTable,  // section outside the file, overlapping or twice
  MissingCode,      // no code section
  BadCode,          // code section not a whole number of words
  BadSymbols,       // symbol section cut or inconsistent
  BadFunctions,     // function section cut or inconsistent
  BadLines,         // line section cut or inconsistent
};
const char* to_text(ImageError error);

// Reads numbers and texts without ever leaving its bytes: beyond the end all reads give 0 and ok() is false.
class Reader {
 public:
  // `base` is where the bytes stand in the file.
  explicit Reader(std::span<const uint8_t> bytes, uint32_t base = 0) : bytes_(bytes), base_(base) {}
  uint32_t u8();
  uint32_t u16();
  uint32_t u32();
  std::string_view text();  // u16 length and bytes
  bool ok() const { return ok_; }
  bool at_end() const { return ok_ && at_ == bytes_.size(); }
  uint32_t offset() const { return base_ + static_cast<uint32_t>(at_); }

 private:
  std::span<const uint8_t> bytes_;
  uint32_t base_;
  size_t at_ = 0;
  bool ok_ = true;
};

// A symbol where it stands.
struct SymbolView {
  std::string_view name;
  uint16_t variable = 0;
  uint16_t count = 0;
};
// Nothing: the section is damaged here.
std::optional<SymbolView> read_symbol(Reader& in);

struct ImageView {
  struct Place {
    uint32_t offset = 0;  // 0: the image has no such section
    std::span<const uint8_t> bytes;
  };

  uint8_t unit = 0;  // row of stdlib/unit_types.def
  uint32_t checksum = 0;
  Place sections[kSections];

  const Place& section(Section kind) const { return sections[static_cast<size_t>(kind) - 1]; }
  Reader reader(Section kind) const { return Reader(section(kind).bytes, section(kind).offset); }
};

// offset is the byte where the trouble was seen.
struct ImageViewResult {
  ImageError error = ImageError::None;
  uint32_t offset = 0;
  ImageView view;
};

// Checks the container: magic, version, checksum, section table. What is in the sections is not looked at.
ImageViewResult view_image(std::span<const uint8_t> bytes);

// CRC-32 (IEEE 802.3, reflected, initial value and final xor 0xFFFFFFFF), as zlib computes it.
uint32_t crc32(std::span<const uint8_t> bytes);

}  // namespace ipos::vm
