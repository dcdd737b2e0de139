// What a test's steps, a script and a page do to a plant.
#include "runtime/plant/hands.hpp"

#include <fmt/format.h>

#include <utility>

namespace ipos::runtime {

Refusal Hands::set(const signals::SignalPort& port, std::string_view name, int32_t value) {
  if (!port.is_input()) return port.write(value);
  if (port.line().driven)
    return fmt::format("{} of {} hangs on a wire or switch: force it, do not set it", name,
                       port.station_name());
  port.line().set = value;
  return std::nullopt;
}

Refusal Hands::force(const signals::SignalPort& port, int32_t value) {
  if (!port.is_input())
    if (auto refused = port.write(value)) return refused;
  plant_.surroundings().force(port, value);
  return std::nullopt;
}

void Hands::release(const signals::SignalPort& port) { plant_.surroundings().release(port); }

void Hands::write_words(Station& station, const DriveWords& words) {
  DriveServer& drive = station.drive();
  const int32_t control = drive.value("101");
  const int32_t setpoint = drive.value("100");
  if (control == 1 || (control == 0 && setpoint == 2))
    drive.state().take_po(PoSource::Rs485, words);
  else if (control == 2 || (control == 0 && setpoint == 3))
    drive.state().take_po(PoSource::Fieldbus, words);
  else
    drive.take_output(plant_.now(), OutputChannel::Single, words);
}

void Hands::set_word(Station& station, uint8_t word, uint16_t value) {
  DriveWords words = station.drive().state().po();
  words[word] = value;
  write_words(station, words);
}

void Hands::force_word(Station& station, uint8_t word, uint16_t value) {
  const bool holds = std::exchange(forced_[&station][word], value).has_value();
  set_word(station, word, value);
  if (!holds) plan_forced(station, word);
}

void Hands::release_word(Station& station, uint8_t word) { forced_[&station][word].reset(); }

void Hands::plan_forced(Station& station, uint8_t word) {
  plant_.surroundings().act(plant_.now() + kMillisecond, [this, &station, word] {
    const std::optional<uint16_t> value = forced_[&station][word];
    if (!value) return;
    set_word(station, word, *value);
    plan_forced(station, word);
  });
}

Refusal Hands::order(Station& station, ProgramOrder order) {
  if (order == ProgramOrder::Stop) {
    station.stop_program();
    return std::nullopt;
  }
  if (order == ProgramOrder::Start && !station.program_over()) return "the program runs already";
  return station.start_program();
}

Refusal Hands::plant_fault(FaultConfig fault, Time at) {
  fault.begin_at(at, 0);
  if (plant_.plant_fault(fault)) return std::nullopt;
  return fmt::format("station '{}' is not on bus '{}'", fault.station, fault.bus);
}

}  // namespace ipos::runtime
