// What a test, a script or a person does to a plant from outside, while it stands between two events or in an action of its
// surroundings. It happens at once; what is forced stays so until it is released.
#pragma once

#include <string_view>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/signal.hpp"

namespace ipos::runtime {

using signals::Refusal;

// Two faults of the same line, station and kind, on the same frames.
bool are_alike(const FaultConfig& one, const FaultConfig& other);
bool is_active(const FaultConfig& fault, Time now);

enum class ProgramOrder : uint8_t { Start, Stop, Restart };

class PlantActions {
 public:
  // `who` holds what is forced: "a test".
  PlantActions(Plant& plant, std::string_view who) : plant_(plant), who_(who) {}
  PlantActions(const PlantActions&) = delete;
  PlantActions& operator=(const PlantActions&) = delete;

  // What is forced keeps its value until it is released.
  Refusal set(const signals::Signal& signal, int64_t value);
  // The same, and again whenever something else has changed it; an input also against wires and switches. A word comes
  // every millisecond, like telegrams of a master that never rests. With a length it ends by itself.
  Refusal force(const signals::Signal& signal, int64_t value, Time length = 0);
  void release(const signals::Signal& signal);
  bool is_forced(const signals::Signal& signal) const;

  static Refusal order(Station& station, ProgramOrder order);

  // Times of the fault count from `at`.
  Refusal plant_fault(FaultConfig fault, Time at);

 private:
  Plant& plant_;
  std::string_view who_;
};

}  // namespace ipos::runtime
