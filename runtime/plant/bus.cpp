// The kinds of bus as a table.
#include "runtime/plant/bus.hpp"

#include "runtime/plant/can_bus.hpp"
#include "runtime/plant/profibus_bus.hpp"
#include "runtime/plant/serial_bus.hpp"

namespace ipos::runtime {
namespace {

template <typename Line>
std::unique_ptr<Bus> make_line(BusPlace place) {
  return std::make_unique<Line>(std::move(place));
}

constexpr auto rate_list(auto... rate) {
  return std::array<uint32_t, sizeof...(rate)>{static_cast<uint32_t>(rate)...};
}

#define BUS_KIND(kind, word, name, line, baud, ...) constexpr auto k##kind##Rates = rate_list(__VA_ARGS__);
#include "runtime/plant/bus_kinds.def"

constexpr BusKindInfo kBusKinds[] = {
#define BUS_KIND(kind, word, name, line, baud, ...)                                       \
  {BusKind::kind,   word,        name, baud, k##kind##Rates, line::kLine, line::kMessage, \
   make_line<line>, line::refuse},
#include "runtime/plant/bus_kinds.def"
};

}  // namespace

const BusKindInfo& info(BusKind kind) { return kBusKinds[static_cast<size_t>(kind)]; }
std::span<const BusKindInfo> bus_kinds() { return kBusKinds; }

}  // namespace ipos::runtime
