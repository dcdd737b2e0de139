// Object by object.
#include "runtime/bus/profibus/fms_objects.hpp"

#include <algorithm>
#include <array>

namespace ipos::profibus {
namespace {

enum Index : uint16_t {
#define FMS_OBJECT(name, index, length, access, text) k##name = index,
#include "runtime/bus/profibus/fms/objects.def"
};

constexpr fms::Object kObjects[] = {
#define FMS_OBJECT(name, index, length, access, text) {index, length, fms::Access::access, text},
#include "runtime/bus/profibus/fms/objects.def"
};

constexpr uint8_t kParameterLength = 4;
constexpr size_t kBlockHead = 2, kEntrySize = 6;

uint16_t word(std::span<const uint8_t> octets) { return static_cast<uint16_t>(octets[0] << 8 | octets[1]); }
uint32_t long_word(std::span<const uint8_t> octets) {
  return uint32_t{word(octets)} << 16 | word(octets.subspan(2));
}
void put(Octets& octets, uint16_t value) {
  octets.push_back(static_cast<uint8_t>(value >> 8));
  octets.push_back(static_cast<uint8_t>(value));
}
void put(Octets& octets, uint32_t value) {
  put(octets, static_cast<uint16_t>(value >> 16));
  put(octets, static_cast<uint16_t>(value));
}

// How many entries a block has; nothing: it is none.
std::optional<size_t> entries_of(std::span<const uint8_t> block) {
  if (block.size() != kBlockHead + kMostBlockEntries * kEntrySize) return std::nullopt;
  const size_t count = block[1];
  return count == 0 || count > kMostBlockEntries ? std::nullopt : std::optional(count);
}

BlockEntry entry_of(std::span<const uint8_t> block, size_t n) {
  const auto entry = block.subspan(kBlockHead + n * kEntrySize, kEntrySize);
  return {word(entry), long_word(entry.subspan(2))};
}

}  // namespace

Octets encode_block(std::span<const BlockEntry> entries) {
  Octets octets{0, static_cast<uint8_t>(entries.size())};
  for (const BlockEntry& entry : entries) {
    put(octets, entry.index);
    put(octets, entry.data);
  }
  octets.resize(kBlockHead + kMostBlockEntries * kEntrySize);
  return octets;
}

std::optional<std::vector<BlockEntry>> decode_block(std::span<const uint8_t> octets) {
  const auto count = entries_of(octets);
  if (!count) return std::nullopt;
  std::vector<BlockEntry> entries;
  for (size_t n = 0; n < *count; ++n) entries.push_back(entry_of(octets, n));
  return entries;
}

std::vector<fms::Object> FmsObjects::list() const {
  std::vector<fms::Object> objects(std::begin(kObjects), std::end(kObjects));
  for (const stdlib::Parameter* parameter : parameters_.table().by_index())
    objects.push_back(*find(static_cast<uint16_t>(kFirstParameterIndex + parameter->index)));
  return objects;
}

// The list of the card is longer than that of the parameters: every index from 1000 on is an object, and the
// inverter refuses what it does not have.
std::optional<fms::Object> FmsObjects::find(uint16_t index) const {
  for (const fms::Object& object : kObjects)
    if (object.index == index) return object;
  if (index < kFirstParameterIndex) return std::nullopt;
  const auto* parameter = parameters_.table().find(static_cast<uint16_t>(index - kFirstParameterIndex));
  return fms::Object{index, kParameterLength, fms::Access::All,
                   parameter != nullptr ? parameter->name : std::string_view{}};
}

void FmsObjects::power_on() {
  pointer_ = {};
  outputs_.assign(outputs_.size(), 0);
}

// In mixed mode the words of the DP master, after its parameter channel; else those written over FMS.
Octets FmsObjects::outputs(size_t length) const {
  Octets octets = outputs_;
  if (const Configuration* dp = slave_.configuration()) {
    octets.assign(slave_.outputs().end() - 2 * dp->words, slave_.outputs().end());
  }
  octets.resize(length);
  return octets;
}

tl::expected<fms::Accessed, ReturnCode> FmsObjects::read_parameter(Time now, uint16_t index, size_t length) {
  const auto value = parameters_.read(now, index);
  if (!value) return tl::unexpected(value.error());
  Octets data;
  put(data, *value);
  data.resize(length);  // left-justified
  return fms::Accessed{data, 1};
}

tl::expected<fms::Accessed, ReturnCode> FmsObjects::read(Time now, uint16_t index) {
  const auto object = find(index);
  if (!object) return tl::unexpected(fms::errors::kNoObject);
  if (object->access == fms::Access::Write) return tl::unexpected(fms::errors::kAccessDenied);
  switch (index) {
    case kOutput1:
    case kOutput2:
    case kOutput3: return fms::Accessed{outputs(object->length)};
    case kInput1:
    case kInput2:
    case kInput3: {
      Octets data;
      for (const uint16_t value : drive_.input(now)) put(data, value);
      data.resize(object->length);
      return fms::Accessed{data};
    }
    case kMinTsdr: return fms::Accessed{{slave_.min_tsdr()}};
    case kDpDiagnosis: {
      Octets data = encode(slave_.diagnosis(now));
      data.resize(kStandardDiagSize);
      return fms::Accessed{data};
    }
    case kReadPointer: {
      Octets data;
      put(data, pointer_.index);
      put(data, pointer_.increment);
      return fms::Accessed{data};
    }
    case kUniversalRead: {
      auto data = read_parameter(now, pointer_.index, object->length);
      pointer_.index = static_cast<uint16_t>(pointer_.index + pointer_.increment);
      return data;
    }
    default: return read_parameter(now, index, object->length);
  }
}

tl::expected<fms::Accessed, ReturnCode> FmsObjects::write_parameter(Time now, uint16_t index, uint32_t data) {
  const auto stored = parameters_.write(now, index, data);
  if (!stored) return tl::unexpected(stored.error());
  return fms::Accessed{{}, 1};
}

// The additional code's high octet tells which entry is wrong; those before it are written, those after not.
tl::expected<fms::Accessed, ReturnCode> FmsObjects::write_block(Time now, std::span<const uint8_t> data) {
  const auto count = entries_of(data);
  if (!count) return tl::unexpected(fms::errors::kTypeConflict);
  uint16_t number = 0;
  while (number < *count) {
    const BlockEntry entry = entry_of(data, number++);
    const auto stored = parameters_.write(now, entry.index, entry.data);
    if (stored) continue;
    ReturnCode code = stored.error();
    code.additional = static_cast<uint16_t>(number << 8 | (code.additional & 0xFF));
    return tl::unexpected(code);
  }
  return fms::Accessed{{}, number};
}

tl::expected<fms::Accessed, ReturnCode> FmsObjects::write(Time now, uint16_t index,
                                                        std::span<const uint8_t> data) {
  const auto object = find(index);
  if (!object) return tl::unexpected(fms::errors::kNoObject);
  if (object->access == fms::Access::Read) return tl::unexpected(fms::errors::kAccessDenied);
  if (data.size() != object->length) return tl::unexpected(fms::errors::kTypeConflict);
  switch (index) {
    case kOutput1:
    case kOutput2:
    case kOutput3: {
      if (slave_.configuration() != nullptr) return tl::unexpected(fms::errors::kAccessDenied);  // DP controls
      std::copy(data.begin(), data.end(), outputs_.begin());
      std::array<uint16_t, 3> words{};
      for (size_t n = 0; n < data.size() / 2; ++n) words[n] = word(data.subspan(2 * n));
      drive_.take_output(now, runtime::OutputChannel::Single, std::span(words).first(data.size() / 2));
      return fms::Accessed{};
    }
    case kMinTsdr:
      if (data[0] < kLeastMinTsdr) return tl::unexpected(runtime::return_codes::kTooSmall);
      slave_.set_min_tsdr(data[0]);
      return fms::Accessed{};
    // Printed as written by all, but without a meaning: refused (ours).
    case kDpDiagnosis:
    case kUniversalRead: return tl::unexpected(fms::errors::kAccessDenied);
    case kDownloadBlock: return write_block(now, data);
    case kUniversalWrite: return write_parameter(now, word(data), long_word(data.subspan(2)));
    case kReadPointer: pointer_ = {word(data), word(data.subspan(2))}; return fms::Accessed{};
    default: return write_parameter(now, index, long_word(data));
  }
}

}  // namespace ipos::profibus
