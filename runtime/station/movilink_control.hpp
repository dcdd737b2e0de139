// A master control on an SBus, with the MOVILINK profile: its place on the line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/sbus_control.hpp"
#include "runtime/station/control.hpp"

namespace ipos::runtime {

class MovilinkControl final : public Control {
 public:
  MovilinkControl(EventQueue& queue, uint32_t source, CanLine& line, const ControlConfig& config,
                  const ControlSettings& settings)
      : Control(config), line_(line), control_(queue, source, settings) {}

  AnyControl self() override { return this; }
  void start() override {
    port_.emplace(line_, line_.attach(name(), line_.baud(), control_));
    control_.start(*port_);
  }

  const SbusControl& control() const { return control_; }

 private:
  CanLine& line_;
  SbusControl control_;
  std::optional<LinePort> port_;
};

}  // namespace ipos::runtime
