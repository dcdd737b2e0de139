// Reader and writer of whole images, for where there is a heap. The container is that of vm/image/view.cpp.
// Text is stored as u16 length and bytes. Numbers are little endian.
#include "vm/image/image.hpp"

#include <algorithm>

namespace ipos::vm {
namespace {

class Writer {
 public:
  void u16(uint32_t v) { number<2>(v); }
  void u32(uint32_t v) { number<4>(v); }
  void text(const std::string& s) {
    const size_t length = std::min<size_t>(s.size(), 0xFFFF);
    u16(static_cast<uint32_t>(length));
    std::copy_n(s.data(), length, room(length));
  }
  void append(const Writer& other) { std::copy_n(other.bytes_.data(), other.size_, room(other.size_)); }
  uint32_t size() const { return static_cast<uint32_t>(size_); }
  std::span<const uint8_t> written() const { return {bytes_.data(), size_}; }
  std::vector<uint8_t> take() {
    bytes_.resize(size_);
    return std::move(bytes_);
  }

 private:
  template <size_t kSize>
  void number(uint32_t v) {
    uint8_t* const to = room(kSize);
    for (size_t n = 0; n < kSize; ++n) to[n] = static_cast<uint8_t>(v >> 8 * n);
  }

  // Where the next bytes go. An image is mostly numbers, thousands of them.
  uint8_t* room(size_t count) {
    if (bytes_.size() < size_ + count) bytes_.resize(2 * (size_ + count));
    size_ += count;
    return bytes_.data() + (size_ - count);
  }

  std::vector<uint8_t> bytes_;
  size_t size_ = 0;  // of what is written
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
    const auto symbol = read_symbol(in);
    if (!symbol) return false;
    image.symbols.push_back({std::string(symbol->name), symbol->variable, symbol->count});
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
  for (uint32_t n = 0; n < files && in.ok(); ++n) image.files.emplace_back(in.text());
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
  Section kind;
  ImageError error;
  bool (*read)(Reader&, Image&);
};
// The code comes first: the other sections are checked against it.
constexpr SectionReader kReaders[] = {{Section::Code, ImageError::BadCode, read_code},
                                      {Section::Symbols, ImageError::BadSymbols, read_symbols},
                                      {Section::Functions, ImageError::BadFunctions, read_functions},
                                      {Section::Lines, ImageError::BadLines, read_lines}};

}  // namespace

std::vector<uint8_t> write_image(const Image& image) {
  std::vector<std::pair<Section, Writer>> sections;
  Writer code;
  for (const uint32_t word : image.code) code.u32(word);
  sections.emplace_back(Section::Code, std::move(code));
  if (!image.symbols.empty()) sections.emplace_back(Section::Symbols, symbols_section(image));
  if (!image.functions.empty()) sections.emplace_back(Section::Functions, functions_section(image));
  if (!image.files.empty()) sections.emplace_back(Section::Lines, lines_section(image));

  Writer out;
  out.u32(kImageMagic);
  out.u32(kImageVersion);
  out.u32(image.unit);
  out.u32(static_cast<uint32_t>(sections.size()));
  uint32_t offset = 16 + 12 * static_cast<uint32_t>(sections.size());
  for (const auto& [kind, payload] : sections) {
    out.u32(static_cast<uint32_t>(kind));
    out.u32(offset);
    out.u32(payload.size());
    offset += payload.size();
  }
  for (const auto& [kind, payload] : sections) out.append(payload);
  out.u32(crc32(out.written()));
  return out.take();
}

ImageResult read_image(std::span<const uint8_t> bytes) {
  const ImageViewResult container = view_image(bytes);
  if (container.error != ImageError::None) return {container.error, container.offset, {}};
  ImageResult result;
  result.image.unit = container.view.unit;
  for (const SectionReader& section : kReaders) {
    if (container.view.section(section.kind).offset == 0) continue;
    Reader in = container.view.reader(section.kind);
    if (!section.read(in, result.image)) return {section.error, in.offset(), {}};
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
