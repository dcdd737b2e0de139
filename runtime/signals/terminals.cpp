// Terminals, by the list of plant_file/terminals.def.
#include <fmt/format.h>

#include <utility>

#include "runtime/signals/collector.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

std::function<int64_t()> reader_of(const Station& station, size_t line) {
  return [&station, line]() -> int64_t { return station.inputs().line(line).value(); };
}

}  // namespace

void add_inputs(Collector& out) {
  for (const BinaryTerminal& terminal : binary_inputs()) {
    Signal& signal = out.add(Group::Input, terminal.name, "binary input", reader_of(out.station(), terminal.bit));
    signal.bits = 1;
    signal.number = terminal.bit;
    signal.limits = {0, 1};
    signal.put = set_input;
  }
}

void add_outputs(Collector& out) {
  for (const BinaryTerminal& terminal : binary_outputs()) {
    Signal& signal = out.add(
        Group::Output, terminal.name, "binary output",
        [&station = out.station(), bit = terminal.bit]() -> int64_t { return station.outputs() >> bit & 1; });
    signal.bits = 1;
    signal.number = terminal.bit;
  }
}

void add_analog(Collector& out) {
  for (const AnalogKind& kind : analog_kinds()) {
    Signal& signal = out.add(Group::Analog, kind.signal, "analog input", reader_of(out.station(), line_of(kind)));
    signal.unit = kind.unit;
    signal.factor = 1 / kind.factor;
    signal.decimals = kind.factor == 10 ? 1 : 3;
    signal.number = line_of(kind);
    signal.put = set_input;
  }
}

Signal live_line(const Signal& analog) {
  const uint32_t second = analog.number + 1;
  const auto is_set = [&] { return std::as_const(*analog.owner).inputs().line(second).value() != 0; };
  if (analog.group != Group::Analog || analog.owner == nullptr || second >= kInputLines ||
      !same_terminal(analog.number, second) || !is_set())
    return analog;
  return *signal_at(*analog.owner, Group::Analog, second);
}

// Of the two lines of an analog input the other one is not there any more.
Refusal set_input(Station& station, uint32_t number, int32_t level) {
  InputLine& line = station.inputs().line(number);
  if (line.driven)
    return fmt::format("{} of {} hangs on a wire or switch: force it, do not set it", input_name(number),
                       station.config().name);
  for (size_t other = kBinaryLines; other < kInputLines; ++other)
    if (number >= kBinaryLines && other != number && same_terminal(number, other)) station.inputs().line(other).set = 0;
  station.inputs().line(number).set = level;
  return std::nullopt;
}

}  // namespace ipos::signals
