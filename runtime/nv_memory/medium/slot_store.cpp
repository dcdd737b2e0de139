// A slot is valid when its checksum over header and payload is right; nothing of it is looked at before. The
// header is written after the payload is on the medium, so a cut leaves an old header with another payload,
// which fails the checksum.
#include "runtime/nv_memory/medium/slot_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "runtime/nv_memory/medium/little_endian.hpp"
#include "vm/image/image.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kMagic = 0x564E5049;  // "IPNV"
constexpr size_t kMagicSize = 4;
constexpr size_t kChecksumSize = 4;
constexpr size_t kPayloadLimit = kSlotStride - kSlotHeaderSize - kChecksumSize;

struct SlotState {
  enum Kind : uint8_t { Empty, Foreign, Bad, Good } kind = Bad;
  std::string trouble;
  uint16_t version = 0;
  uint8_t unit = 0;
  uint32_t sequence = 0;
  std::optional<NvContent> content;  // of a good slot of our version
};

std::vector<uint8_t> header_of(uint8_t unit, uint32_t sequence, uint32_t length) {
  std::vector<uint8_t> header;
  put(header, kMagic, 4);
  put(header, kNvVersion, 2);
  put(header, unit, 1);
  put(header, 0, 1);
  put(header, sequence, 4);
  put(header, length, 4);
  return header;
}

SlotState bad(std::string trouble) {
  SlotState state;
  state.trouble = std::move(trouble);
  return state;
}

// Nothing was stored here. The first store begins a file with the magic alone, so zeros in its place are of
// something else, unless the file ends with them: then the power was cut.
bool is_empty(std::span<const uint8_t> header, uint64_t offset) {
  const auto all_zero = [](std::span<const uint8_t> bytes) {
    return std::all_of(bytes.begin(), bytes.end(), [](uint8_t byte) { return byte == 0; });
  };
  if (all_zero(header)) return offset != 0 || header.size() < kSlotHeaderSize;
  std::vector<uint8_t> magic;
  put(magic, kMagic, static_cast<int>(kMagicSize));
  const auto first = header.first(std::min(header.size(), kMagicSize));
  return std::equal(first.begin(), first.end(), magic.begin()) && all_zero(header.subspan(first.size()));
}

// The error is that of the medium.
tl::expected<SlotState, std::string> read_slot(NvMedium& medium, uint64_t offset) {
  std::vector<uint8_t> bytes(kSlotHeaderSize);
  const auto got = medium.read(offset, bytes);
  if (!got) return tl::unexpected(got.error());
  const std::span<const uint8_t> found = std::span(bytes).first(*got);
  SlotState state;
  if (is_empty(found, offset)) {
    state.kind = SlotState::Empty;
    return state;
  }
  LittleEndianReader header{bytes};
  if (header.take(4) != kMagic) {
    state.kind = SlotState::Foreign;
    state.trouble = "no memory of a unit";
    return state;
  }
  if (*got < kSlotHeaderSize) return bad("cut off in its header");
  state.version = static_cast<uint16_t>(header.take(2));
  state.unit = static_cast<uint8_t>(header.take(1));
  header.take(1);
  state.sequence = header.take(4);
  const uint32_t length = header.take(4);
  if (length > kPayloadLimit) return bad("wrong length in its header");

  bytes.resize(kSlotHeaderSize + length + kChecksumSize);
  const std::span<uint8_t> rest = std::span(bytes).subspan(kSlotHeaderSize);
  const auto more = medium.read(offset + kSlotHeaderSize, rest);
  if (!more) return tl::unexpected(more.error());
  if (*more < rest.size()) return bad("cut off");
  const std::span<const uint8_t> checked = std::span(bytes).first(kSlotHeaderSize + length);
  LittleEndianReader checksum{std::span(bytes).last(kChecksumSize)};
  if (checksum.take(4) != vm::crc32(checked)) return bad("wrong checksum");
  state.kind = SlotState::Good;
  if (state.version != kNvVersion) return state;
  state.content = decode_content(checked.subspan(kSlotHeaderSize));
  if (!state.content) return bad("right checksum, but no content");
  return state;
}

// Sequence numbers wrap; the two slots are at most one apart.
bool newer(uint32_t a, uint32_t b) { return static_cast<int32_t>(a - b) > 0; }

}  // namespace

NvLoad SlotStore::load() {
  SlotState slots[2];
  std::string troubles;
  for (unsigned n = 0; n < 2; ++n) {
    auto state = read_slot(medium_, n * kSlotStride);
    if (!state) return {NvOutcome::Failed, {}, "cannot be read: " + state.error()};
    slots[n] = std::move(*state);
    if (slots[n].kind == SlotState::Bad || slots[n].kind == SlotState::Foreign)
      troubles += fmt::format("{}slot {} at byte {}: {}", troubles.empty() ? "" : "; ", n, n * kSlotStride,
                              slots[n].trouble);
  }
  const bool second = slots[1].kind == SlotState::Good &&
                      (slots[0].kind != SlotState::Good || newer(slots[1].sequence, slots[0].sequence));
  SlotState& best = slots[second ? 1 : 0];
  if (best.kind != SlotState::Good) {
    if (slots[0].kind == SlotState::Foreign)
      return {NvOutcome::Refused, {}, "this is no memory of a unit, and is left as it is"};
    loaded_ = true;
    next_slot_ = 0;
    sequence_ = 0;
    is_new_ = troubles.empty();
    if (is_new_) return {NvOutcome::Fresh, {}, {}};
    return {NvOutcome::Damaged, {}, "no state in it is whole: " + troubles};
  }
  if (best.version != kNvVersion)
    return {NvOutcome::Refused, {}, fmt::format("written by a newer version of ipos ({})", best.version)};
  if (best.unit != unit_)
    return {NvOutcome::Refused, {}, fmt::format("the memory of unit type {}", best.unit)};
  loaded_ = true;
  next_slot_ = second ? 0 : 1;
  sequence_ = best.sequence;
  if (!troubles.empty()) troubles += "; the other slot is used";
  return {NvOutcome::Loaded, std::move(*best.content), std::move(troubles)};
}

std::optional<std::string> SlotStore::save(const NvContent& content) {
  assert(loaded_);
  std::vector<uint8_t> bytes = encode(content);
  if (bytes.size() > kPayloadLimit) return "the content is longer than a slot";
  std::vector<uint8_t> checked = header_of(unit_, sequence_ + 1, static_cast<uint32_t>(bytes.size()));
  checked.insert(checked.end(), bytes.begin(), bytes.end());
  put(bytes, vm::crc32(checked), static_cast<int>(kChecksumSize));

  const std::span<const uint8_t> header = std::span(checked).first(kSlotHeaderSize);
  if (is_new_) {  // from now on the file can be told from one of somebody else
    if (auto why = medium_.write(0, header.first(kMagicSize))) return why;
    if (auto why = medium_.sync()) return why;
    is_new_ = false;
  }
  const uint64_t offset = next_slot_ * kSlotStride;
  if (auto why = medium_.write(offset + kSlotHeaderSize, bytes)) return why;
  if (auto why = medium_.sync()) return why;
  if (auto why = medium_.write(offset, header)) return why;
  if (auto why = medium_.sync()) return why;
  ++sequence_;
  next_slot_ ^= 1U;
  return std::nullopt;
}

}  // namespace ipos::runtime
