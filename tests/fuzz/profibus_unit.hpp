// The unit behind a slave of the targets for PROFIBUS: outputs reach it in data exchange only, as long as configured.
#pragma once

#include "runtime/bus/profibus/dp_slave.hpp"
#include "tests/fuzz/fuzz.hpp"

namespace ipos::tests {

struct ProfibusUnit final : profibus::SlaveUnit {
  void configured(runtime::Time, const profibus::Configuration& configuration) override { octets = configuration.octets; }
  void take_outputs(runtime::Time, std::span<const uint8_t> outputs) override {
    require(octets != 0 && outputs.size() == octets, "outputs come in data exchange, as configured");
  }
  void read_inputs(runtime::Time, std::span<uint8_t> inputs) override {
    require(octets != 0 && inputs.size() == octets, "inputs are read in data exchange, as configured");
  }
  void watchdog_set(runtime::Time, std::optional<runtime::Time> period) override {
    require(!period || *period >= 10 * runtime::kMillisecond, "a watchdog has a time");
  }
  void watchdog_expired(runtime::Time) override { octets = 0; }
  void exchange_ended(runtime::Time) override {
    require(octets != 0, "what ends has begun");
    octets = 0;
  }
  size_t octets = 0;
};

}  // namespace ipos::tests
