// What a test's steps, a script and a page do to a plant.
#include "runtime/plant/actions.hpp"

#include <fmt/format.h>

namespace ipos::runtime {

bool are_alike(const FaultConfig& one, const FaultConfig& other) {
  const auto kind = [](const FaultConfig& fault) {
    return fault.octets ? static_cast<int>(fault.octets->kind) : static_cast<int>(fault.fault.kind);
  };
  return one.bus == other.bus && one.station == other.station && one.octets.has_value() == other.octets.has_value() &&
         kind(one) == kind(other) && one.fault.id == other.fault.id;
}

bool is_active(const FaultConfig& fault, Time now) {
  const auto within = [now](const auto& part) { return part.from <= now && now < part.until; };
  return fault.octets ? within(*fault.octets) : within(fault.fault);
}

Refusal PlantActions::set(const signals::Signal& signal, int64_t value) { return signal.write(value); }

Refusal PlantActions::force(const signals::Signal& signal, int64_t value, Time length) {
  return plant_.surroundings().force(signal, value, who_, length);
}

void PlantActions::release(const signals::Signal& signal) { plant_.surroundings().release(signal); }

bool PlantActions::is_forced(const signals::Signal& signal) const {
  return signals::is_forced(plant_.surroundings().holds(), signal);
}

Refusal PlantActions::order(Station& station, ProgramOrder order) {
  if (order == ProgramOrder::Stop) {
    station.stop_program();
    return std::nullopt;
  }
  if (order == ProgramOrder::Start && !station.program_over()) return "the program runs already";
  return station.start_program();
}

Refusal PlantActions::plant_fault(FaultConfig fault, Time at) {
  fault.begin_at(at, 0);
  if (plant_.plant_fault(fault)) return std::nullopt;
  return fmt::format("station '{}' is not on bus '{}'", fault.station, fault.bus);
}

}  // namespace ipos::runtime
