// A master of CANopen among the controls of a plant: what it meets at its nodes goes into the journal.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/canopen/master.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/station/control.hpp"

namespace ipos::runtime {

class CanopenControl final : public Control, private canopen::MasterObserver {
 public:
  // All references must outlive it.
  CanopenControl(EventQueue& queue, uint32_t source, CanLine& line, const ControlConfig& config,
                 const canopen::MasterSettings& settings, Journal& journal)
      : Control(config),
        queue_(queue),
        line_(line),
        settings_(settings),
        journal_(journal),
        master_(queue, source, settings, this) {}

  AnyControl self() override { return this; }
  void start() override {
    port_.emplace(line_, line_.attach(name(), line_.baud(), master_));
    master_.start(queue_.now(), *port_);
  }

  const canopen::MasterSettings& settings() const { return settings_; }
  canopen::Master& master() { return master_; }
  const canopen::Master& master() const { return master_; }

 private:
  void on_node(Time now, bool wrong, std::string text) override {
    journal_.note(now, wrong ? Weight::Warning : Weight::Why, name(), std::move(text));
  }

  EventQueue& queue_;
  CanLine& line_;
  const canopen::MasterSettings& settings_;
  Journal& journal_;
  canopen::Master master_;
  std::optional<LinePort> port_;
};

}  // namespace ipos::runtime
