// Hands that act on a plant from outside while it stands between two events, or in an action of its surroundings: tests,
// the plant as a library, a page. What they do happens at once; what they hold, they hold until it is released.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/signal_port.hpp"

namespace ipos::runtime {

// Why it was not done; nothing when it was.
using Refusal = std::optional<std::string>;

enum class ProgramOrder : uint8_t { Start, Stop, Restart };

class Hands {
 public:
  static constexpr uint8_t kWords = 3;  // PO1..PO3

  explicit Hands(Plant& plant) : plant_(plant) {}
  Hands(const Hands&) = delete;
  Hands& operator=(const Hands&) = delete;

  // A variable or parameter is written as over the parameter channel, volatile; an input gets this level. `name` is for
  // the refusal.
  static Refusal set(const signals::SignalPort& port, std::string_view name, int32_t value);
  // The same, and again whenever something else has changed it; an input also against wires and switches.
  Refusal force(const signals::SignalPort& port, int32_t value);
  void release(const signals::SignalPort& port);

  // A process output word PO1..PO3 (0..2) comes as over the bus that P101 names, or P100, or else the SBus; forced it comes
  // every millisecond, like telegrams of a master that never rests.
  void set_word(Station& station, uint8_t word, uint16_t value);
  void force_word(Station& station, uint8_t word, uint16_t value);
  void release_word(Station& station, uint8_t word);

  static Refusal order(Station& station, ProgramOrder order);

  // Times of the fault count from `at`.
  Refusal plant_fault(FaultConfig fault, Time at);

 private:
  void write_words(Station& station, const DriveWords& words);
  void plan_forced(Station& station, uint8_t word);

  Plant& plant_;
  std::map<Station*, std::array<std::optional<uint16_t>, kWords>> forced_;
};

}  // namespace ipos::runtime
