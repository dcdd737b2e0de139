// The class that each kind of bus has.
#include "runtime/plant/bus.hpp"

#include "runtime/plant/can_bus.hpp"
#include "runtime/plant/profibus_bus.hpp"
#include "runtime/plant/serial_bus.hpp"

namespace ipos::runtime {

std::unique_ptr<Bus> make_bus(BusPlace place) {
  switch (place.config.kind) {
#define BUS_KIND(kind, word, name, line, message, Class, ...) \
  case BusKind::kind: return std::make_unique<Class>(std::move(place));
#include "runtime/plant_file/bus_kinds.def"
  }
  return nullptr;
}

std::optional<std::string> refuse_message(BusKind bus, const std::string& text) {
  switch (bus) {
#define BUS_KIND(kind, word, name, line, message, Class, ...) \
  case BusKind::kind: return Class::refuse(text);
#include "runtime/plant_file/bus_kinds.def"
  }
  return std::nullopt;
}

}  // namespace ipos::runtime
