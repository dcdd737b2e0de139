// What a plant consists of, for who looks at all of it: names of signals, telegrams of lines. runtime/plant has the plant
// itself.
#pragma once

#include <memory>
#include <vector>

#include "runtime/station/bus.hpp"
#include "runtime/station/canopen_control.hpp"
#include "runtime/station/gateway.hpp"
#include "runtime/station/profibus_control.hpp"
#include "runtime/station/station.hpp"

namespace ipos::runtime {

// A master control and its place on a line.
struct PlantControl {
  const ControlConfig* config;
  CanLine* line;  // null: it is a master on a PROFIBUS
  std::unique_ptr<SbusControl> control;
  std::unique_ptr<CanopenControl> canopen;  // in place of the former
  std::unique_ptr<LinePort> port;
  std::unique_ptr<ProfibusControl> profibus;
  std::unique_ptr<Gateway> gateway{};
};

class PlantParts {
 public:
  virtual const std::vector<std::unique_ptr<Station>>& stations() const = 0;
  // Of the file in its order, then those to keypads.
  virtual const std::vector<std::unique_ptr<Bus>>& buses() const = 0;
  virtual const std::vector<PlantControl>& controls() const = 0;
  virtual Time now() const = 0;

 protected:
  ~PlantParts() = default;
};

}  // namespace ipos::runtime
