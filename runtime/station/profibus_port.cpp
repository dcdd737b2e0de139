// The card's calls go through the door of the unit.
#include "runtime/station/profibus_port.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/drive/indices.hpp"

namespace ipos::runtime {

// Its timers run with the line's events, before the tick of the same moment.
ProfibusPort::ProfibusPort(EventQueue& queue, ProfibusBus& bus, const StationConfig& station, Door& door,
                           Journal& journal)
    : queue_(queue),
      station_(station.name),
      line_(bus.line()),
      own_numbers_(station.unit->has(stdlib::Trait::OwnParameterNumbers)),
      door_(door),
      journal_(journal),
      server_(door),
      card_(queue, bus.source(), bus.line(), station.name, *station.profibus.option,
            {station.profibus.address, station.profibus.fms_switch, station.profibus.terminator.value_or(false)}, *this, stdlib::parameter_table(*station.unit), *this,
            this) {
  power_on();
}

void ProfibusPort::power_on() {
  card_.power_on(queue_.now(), false);
  next_fault_ = queue_.now();
  link_lost_ = false;
  noted_.reset();
}

Time ProfibusPort::tick(Time now) {
  while (next_fault_ <= now) {
    const uint8_t fault = door_.look().drive().fault();
    card_.station().slave().set_fault(now, fault == 0 ? std::nullopt : std::optional(fault));
    next_fault_ += profibus::UnitFault::kRefresh;
  }
  return next_fault_;
}

// Save EEPROM P802 = OFF of a MOVITRAC 31: nothing is stored (MOVITRAC 31 PROFIBUS, 6).
tl::expected<int32_t, ReturnCode> ProfibusPort::serve(Time now, const ParameterRequest& request) {
  if (link_lost_) return tl::unexpected(stdlib::return_codes::kCommunication);
  ParameterRequest wanted = request;
  const bool stores = !own_numbers_ || door_.look().server().parameters().value(index::kM31SaveEeprom) != 0;
  if (wanted.service == Service::Write && !stores) wanted.service = Service::WriteVolatile;
  auto reply = server_.serve(now, wanted);
  tell_reasons(now);
  return reply;
}

void ProfibusPort::take_output(Time now, OutputChannel, std::span<const uint16_t> words) {
  if (link_lost_) return;
  door_.touch().server().take_fieldbus(words);
  tell_reasons(now);
}

profibus::FurtherWords ProfibusPort::further_input(Time /*now*/) { return door_.look().drive().further_pi(); }

// The drive of a MOVIDRIVE monitors its process data itself (P819), in Sync mode, too, when no words come.
void ProfibusPort::cyclic_request(Time) {
  if (!own_numbers_ && !link_lost_) door_.touch().server().fieldbus_request();
}

// The watchdog time of the master replaces what the parameter had.
void ProfibusPort::set_fieldbus_timeout(Time, int32_t hundredths) {
  ParameterStore& parameters = door_.touch().server().parameters();
  if (own_numbers_) return parameters.set_working(index::kM31Timeout, hundredths);
  constexpr int32_t kMsAHundredth = 10;
  parameters.set_working(index::kFieldbusTimeout, kMsAHundredth * hundredths);
  parameters.set_display(index::kFieldbusBaud, static_cast<int32_t>(line_.baud()));
}

void ProfibusPort::fieldbus_timeout_expired(Time) {
  if (own_numbers_) door_.touch().server().fieldbus_lost();
}

void ProfibusPort::set_fieldbus_address(Time, uint8_t address) {
  door_.touch().server().show_fieldbus_card(address);
}

void ProfibusPort::on_note(Time now, profibus::SlaveNote what, uint8_t master) {
  if (const Noted one{what, master}; std::exchange(noted_, one) == one) return;
  note(now, fmt::format("{}{}", profibus::slave_note_text(what),
                        master == profibus::kNoMaster ? "" : fmt::format(" (master {})", master)));
}

void ProfibusPort::tell_reasons(Time now) {
  for (std::string& reason : server_.take_reasons()) note(now, std::move(reason));
}

void ProfibusPort::note(Time now, std::string text) {
  journal_.note(now, Weight::Why, station_, "PROFIBUS: " + std::move(text));
}

}  // namespace ipos::runtime
