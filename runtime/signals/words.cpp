// Words of process data: as they go over the bus, and the numbers that they are by their assignment at present.
#include <fmt/format.h>

#include "runtime/bus/movilink/process_words.hpp"
#include "runtime/signals/collector.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

int64_t process_word(const Station& station, bool input, size_t word) {
  const Drive& drive = station.drive().state();
  return input ? drive.pi()[word] : drive.po()[word];
}

void add_word(Collector& out, bool input, size_t word) {
  const Station& station = out.station();
  const std::string name = fmt::format("{}{}", input ? "PI" : "PO", word + 1);
  const auto* row = find_parameter(*station.config().unit, fmt::format("87{}", (input ? 3 : 0) + word));
  const auto code =
      row == nullptr ? uint8_t{0} : static_cast<uint8_t>(station.drive().parameters().value(row->index));
  const std::string_view assigned = process_word_name(*station.config().unit, input, code);
  Signal& signal = out.add(Group::ProcessData, name, assigned,
                           [&station, input, word] { return process_word(station, input, word); });
  signal.bits = kWordBits;
  signal.number = static_cast<uint32_t>(word + (input ? kProcessWords : 0));
  if (!input) {
    signal.limits = {INT16_MIN, UINT16_MAX};
    signal.put = set_word;
  }
  const ProcessWordScale scale = process_word_scale(input, code);
  if (scale.denominator == 0 || scale.unit.empty()) return;
  Signal& number = out.add(Group::ProcessData, name + "_value", assigned,
                           [&station, input, word, is_signed = scale.is_signed]() -> int64_t {
                             const auto bits = static_cast<uint16_t>(process_word(station, input, word));
                             return is_signed ? int64_t{static_cast<int16_t>(bits)} : bits;
                           });
  number.number = UINT32_MAX;
  number.unit = scale.unit;
  number.factor = static_cast<double>(scale.numerator) / scale.denominator;
  number.decimals = scale.denominator == 1 ? 0 : scale.denominator <= 10 ? 1 : 2;
}

}  // namespace

void add_words(Collector& out) {
  for (const bool input : {false, true})
    for (size_t word = 0; word < kProcessWords; ++word) add_word(out, input, word);
  const Station& station = out.station();
  if (!station.has_further_words()) return;
  for (const bool input : {false, true})
    for (size_t word = 0; word < kFurtherWords; ++word) {
      Signal& signal = out.add(Group::ProcessData, fmt::format("{}{}", input ? "PI" : "PO", kProcessWords + word + 1),
                               "word of the program", [&station, input, word]() -> int64_t {
                                 const Drive& drive = station.drive().state();
                                 return (input ? drive.further_pi() : drive.further_po())[word];
                               });
      signal.bits = kWordBits;
      signal.number = UINT32_MAX;
    }
}

// As over the bus that P101 names, or P100, or else the SBus.
Refusal set_word(Station& station, uint32_t word, int32_t value) {
  UnitInterface& drive = station.drive();
  DriveWords words = drive.state().po();
  words[word] = static_cast<uint16_t>(value);
  const auto control = static_cast<stdlib::ControlSource>(drive.value("101"));
  const auto setpoint = static_cast<stdlib::SetpointSource>(drive.value("100"));
  const auto names = [&](PoSource bus) {
    const BusSource& row = bus_source(bus);
    return control == row.control || (control == stdlib::ControlSource::Terminals && setpoint == row.setpoint);
  };
  if (names(PoSource::Rs485))
    drive.state().take_po(PoSource::Rs485, words);
  else if (names(PoSource::Fieldbus))
    drive.state().take_po(PoSource::Fieldbus, words);
  else
    drive.take_output(station.now(), OutputChannel::Single, words);
  return std::nullopt;
}

}  // namespace ipos::signals
