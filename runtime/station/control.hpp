// What takes part in a plant without being a station with a drive: the masters of its lines, and gateways. A new kind is
// a class of this, an alternative of ControlConfig::kind and a maker in control.cpp; who visits controls has a case for
// each, or does not compile.
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "runtime/clock/event_queue.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/station/visit.hpp"

namespace ipos::runtime {

class MovilinkControl;
class CanopenControl;
class ProfibusControl;
class FmsControl;
class Gateway;
class PlantParts;

using AnyControl = std::variant<MovilinkControl*, CanopenControl*, ProfibusControl*, FmsControl*, Gateway*>;

class Control {
 public:
  explicit Control(const ControlConfig& config) : config_(config) {}  // it outlives the control
  Control(const Control&) = delete;
  Control& operator=(const Control&) = delete;
  virtual ~Control() = default;

  virtual AnyControl self() = 0;
  // Once, at the place of the control in the plant file: joins the lines that it has not joined yet, and begins.
  virtual void start() = 0;

  const ControlConfig& config() const { return config_; }
  const std::string& name() const { return config_.name; }

 private:
  const ControlConfig& config_;
};

// Where a control is made: with the lines and stations that the plant has by now.
struct ControlPlace {
  const PlantParts& plant;
  EventQueue& queue;
  uint32_t& next_source;  // one for each control that is made
  Journal& journal;
};

// Null: a line is not there, or `errors` says what is wrong.
std::unique_ptr<Control> make_control(const ControlPlace& place, const ControlConfig& config,
                                      std::vector<PlantError>& errors);

}  // namespace ipos::runtime
