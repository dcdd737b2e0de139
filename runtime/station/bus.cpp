// The class that each kind of bus has.
#include "runtime/station/bus.hpp"

#include <utility>

namespace ipos::runtime {

#define BUS_KIND(kind, word, name, line, message, Class, ...) \
  std::unique_ptr<Bus> make_##Class(BusPlace place);          \
  std::optional<std::string> refuse_##Class(const std::string& text);
#include "runtime/plant_file/bus_kinds.def"

std::unique_ptr<Bus> make_bus(BusPlace place) {
  switch (place.config.kind) {
#define BUS_KIND(kind, word, name, line, message, Class, ...) \
  case BusKind::kind: return make_##Class(std::move(place));
#include "runtime/plant_file/bus_kinds.def"
  }
  return nullptr;
}

std::optional<std::string> refuse_message(BusKind bus, const std::string& text) {
  switch (bus) {
#define BUS_KIND(kind, word, name, line, message, Class, ...) \
  case BusKind::kind: return refuse_##Class(text);
#include "runtime/plant_file/bus_kinds.def"
  }
  return std::nullopt;
}

}  // namespace ipos::runtime
