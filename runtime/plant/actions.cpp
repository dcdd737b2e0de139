// What a test's steps, a script and a page do to a plant.
#include "runtime/plant/actions.hpp"

#include <fmt/format.h>

namespace ipos::runtime {

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
