// The kinds of bus as a plant file knows them: their words and rates, from bus_kinds.def.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "runtime/bus/rs485/octet_fault.hpp"

namespace ipos::runtime {

enum class BusKind : uint8_t {
#define BUS_KIND(kind, ...) kind,
#include "runtime/plant_file/bus_kinds.def"
};

constexpr bool is_serial(BusKind kind) { return kind == BusKind::Rs485 || kind == BusKind::Rs232; }
constexpr bool carries_octets(BusKind kind) { return is_serial(kind) || kind == BusKind::Profibus; }

// Of one that carries octets.
constexpr OctetLine octet_line_of(BusKind kind) {
  switch (kind) {
    case BusKind::Rs232: return OctetLine::Rs232;
    case BusKind::Rs485: return OctetLine::Rs485;
    default: return OctetLine::Profibus;
  }
}

struct BusKindInfo {
  BusKind kind;
  std::string_view word;
  std::string_view name;
  std::string_view line;     // what one is called: "a serial line"
  std::string_view message;  // what it carries: "frame", "telegram"
  uint32_t baud;             // bit/s, where the file gives none
  std::span<const uint32_t> rates;
};
const BusKindInfo& info(BusKind kind);
std::span<const BusKindInfo> bus_kinds();

}  // namespace ipos::runtime
