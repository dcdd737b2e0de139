// A plant with what the library does and hears in it: everything that is rebuilt when a state is restored.
#pragma once

#include <memory>
#include <vector>

#include "runtime/library/bus_tap.hpp"
#include "runtime/library/action.hpp"
#include "runtime/library/can_nodes.hpp"
#include "runtime/plant/actions.hpp"

namespace ipos::library {

class Instance {
 public:
  explicit Instance(std::unique_ptr<runtime::Plant> plant);

  // Does it now. Actions may come from anywhere: one that this plant cannot have seen is refused.
  Refusal perform(const Action& action);

  // Writes a signal of this plant.
  Refusal set(const signals::Signal& signal, int64_t value) { return actions_.set(signal, value); }

  // Who speaks FMS on the line; null: it is no PROFIBUS.
  runtime::FmsOperator* fms(uint32_t line);

  runtime::Plant& plant() { return *plant_; }
  const runtime::Plant& plant() const { return *plant_; }
  std::vector<std::unique_ptr<CanTap>>& can() { return can_; }
  CanNodes* nodes(size_t line) { return line < nodes_.size() ? nodes_[line].get() : nullptr; }  // null: none have joined
  std::vector<std::unique_ptr<SerialTap>>& serial() { return serial_; }
  std::vector<std::unique_ptr<ProfibusTap>>& profibus() { return profibus_; }

  // Runs `action(tap)` for the line of this number: CAN lines first, then serial ones, then PROFIBUS. False: there is none.
  template <typename Do>
  bool with_line(size_t number, Do action) {
    const auto among = [&](auto& taps) {
      if (number < taps.size()) return action(*taps[number]), true;
      number -= taps.size();
      return false;
    };
    return among(can_) || among(serial_) || among(profibus_);
  }
  size_t line_count() const { return can_.size() + serial_.size() + profibus_.size(); }

 private:
  Refusal touch(const Action& action);
  Refusal send(const Action& action);
  Refusal tell_node(const Action& action);
  Refusal plant_faults(const Action& action);
  Refusal ask_fms(const Action& action);

  std::unique_ptr<runtime::Plant> plant_;
  runtime::PlantActions actions_;
  std::vector<std::unique_ptr<CanTap>> can_;
  std::vector<std::unique_ptr<CanNodes>> nodes_;  // one a CAN line
  std::vector<std::unique_ptr<SerialTap>> serial_;
  std::vector<std::unique_ptr<ProfibusTap>> profibus_;
};

// A frame in a action, and back; nothing when the bytes are none.
std::vector<uint8_t> frame_bytes(const runtime::Frame& frame);
std::optional<runtime::Frame> frame_of(std::span<const uint8_t> bytes);

}  // namespace ipos::library
