// What a PDO carries: the entries of a mapping parameter (CiA 301).
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/bus/canopen/object_dictionary.hpp"

namespace ipos::runtime::canopen {

inline constexpr unsigned kPdoBits = 64;

struct Mapped {
  Address address;
  uint8_t bits = 0;
  friend bool operator==(const Mapped&, const Mapped&) = default;
};

constexpr Mapped mapped_of(uint32_t entry) {
  return {{static_cast<uint16_t>(entry >> 16), static_cast<uint8_t>(entry >> 8)},
          static_cast<uint8_t>(entry)};
}
constexpr uint32_t mapping_entry(const Mapped& mapped) {
  return uint32_t{mapped.address.index} << 16 | uint32_t{mapped.address.sub} << 8 | mapped.bits;
}

// A process word; others are dummies, that stand for bits of somebody else.
constexpr bool is_word(const Mapped& mapped) {
  const Address& at = mapped.address;
  return (at.index == objects::kOutput || at.index == objects::kInput) && at.sub >= 1 &&
         at.sub <= objects::kProcessWords && mapped.bits == 16;
}

using Mapping = std::vector<Mapped>;
Mapping mapping_of(const ObjectDictionary& dictionary, uint16_t mapping_index);
unsigned bits_of(const Mapping& mapping);

}  // namespace ipos::runtime::canopen
