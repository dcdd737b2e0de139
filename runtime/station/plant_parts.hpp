// What a plant consists of, for who looks at all of it: names of signals, telegrams of lines. runtime/plant has the plant
// itself.
#pragma once

#include <memory>
#include <string_view>
#include <type_traits>
#include <vector>

#include "runtime/station/bus.hpp"
#include "runtime/station/can_bus.hpp"
#include "runtime/station/canopen_control.hpp"
#include "runtime/station/fms_control.hpp"
#include "runtime/station/gateway.hpp"
#include "runtime/station/movilink_control.hpp"
#include "runtime/station/profibus_control.hpp"
#include "runtime/station/serial_bus.hpp"
#include "runtime/station/station.hpp"

namespace ipos::runtime {

class PlantParts {
 public:
  virtual const std::vector<std::unique_ptr<Station>>& stations() const = 0;
  // Of the file in its order, then those to keypads.
  virtual const std::vector<std::unique_ptr<Bus>>& buses() const = 0;
  virtual const std::vector<std::unique_ptr<Control>>& controls() const = 0;
  virtual Time now() const = 0;

  // Those buses or controls that are of one class, in their order: all<CanBus>(), all<Gateway>().
  template <typename Class>
  std::vector<Class*> all() const {
    if constexpr (std::is_base_of_v<Bus, Class>)
      return of_class<Class>(buses());
    else
      return of_class<Class>(controls());
  }
  // Null: there is none.
  Bus* find_bus(std::string_view name) const;
  Gateway* find_gateway(std::string_view name) const;

 protected:
  ~PlantParts() = default;
};

}  // namespace ipos::runtime
