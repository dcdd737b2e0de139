// Coding of the payload. The checksum has been checked before; a payload that is none although it is right
// was made by somebody else.
#include "runtime/nv_memory/medium/nv_content.hpp"

#include "runtime/nv_memory/medium/little_endian.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kEntrySize = 6;  // index and number

template <typename Number>
void put_list(std::vector<uint8_t>& out, const std::vector<std::pair<uint16_t, Number>>& list) {
  put(out, static_cast<uint32_t>(list.size()), 4);
  for (const auto& [index, number] : list) {
    put(out, index, 2);
    put(out, static_cast<uint32_t>(number), 4);
  }
}

// False when the entries do not fit or their indices do not rise.
template <typename Number>
bool take_list(LittleEndianReader& in, std::vector<std::pair<uint16_t, Number>>& list) {
  const uint32_t count = in.take(4);
  if (!in.good || count > in.rest.size() / kEntrySize) return false;
  list.reserve(count);
  for (uint32_t i = 0; i < count; ++i) {
    const auto index = static_cast<uint16_t>(in.take(2));
    const auto number = static_cast<Number>(in.take(4));
    if (!list.empty() && list.back().first >= index) return false;
    list.emplace_back(index, number);
  }
  return true;
}

}  // namespace

std::vector<uint8_t> encode(const NvContent& content) {
  std::vector<uint8_t> out;
  out.reserve(16 + kEntrySize * (content.values.size() + content.writes.size()));
  put_list(out, content.values);
  put_list(out, content.writes);
  put(out, content.program ? 1 : 0, 1);
  if (!content.program) return out;
  put(out, content.program->origin, 4);
  put(out, static_cast<uint32_t>(content.program->words.size()), 4);
  for (const uint32_t word : content.program->words) put(out, word, 4);
  return out;
}

std::optional<NvContent> decode_content(std::span<const uint8_t> bytes) {
  LittleEndianReader in{bytes};
  NvContent content;
  if (!take_list(in, content.values) || !take_list(in, content.writes)) return std::nullopt;
  const uint32_t has_program = in.take(1);
  if (!in.good || has_program > 1) return std::nullopt;
  if (has_program == 1) {
    NvProgram program;
    program.origin = in.take(4);
    const uint32_t count = in.take(4);
    if (!in.good || count != in.rest.size() / 4) return std::nullopt;
    for (uint32_t i = 0; i < count; ++i) program.words.push_back(in.take(4));
    content.program = std::move(program);
  }
  if (!in.good || !in.rest.empty()) return std::nullopt;
  return content;
}

}  // namespace ipos::runtime
