// The kinds of bus as a table.
#include "runtime/plant_file/bus_kind.hpp"

#include <array>
#include <cstddef>

namespace ipos::runtime {
namespace {

constexpr auto rate_list(auto... rate) {
  return std::array<uint32_t, sizeof...(rate)>{static_cast<uint32_t>(rate)...};
}

#define BUS_KIND(kind, word, name, line, message, Class, baud, ...) \
  constexpr auto k##kind##Rates = rate_list(__VA_ARGS__);
#include "runtime/plant_file/bus_kinds.def"

constexpr BusKindInfo kBusKinds[] = {
#define BUS_KIND(kind, word, name, line, message, Class, baud, ...) \
  {BusKind::kind, word, name, line, message, baud, k##kind##Rates},
#include "runtime/plant_file/bus_kinds.def"
};

}  // namespace

const BusKindInfo& info(BusKind kind) { return kBusKinds[static_cast<size_t>(kind)]; }
std::span<const BusKindInfo> bus_kinds() { return kBusKinds; }

}  // namespace ipos::runtime
