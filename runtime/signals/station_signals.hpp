// Everything of a station that has a value and a name: the one naming of traces, plots, watches, scopes and
// expectations. A signal is found once and read as often as wanted. docs/guide/recording.md has the names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/station/station.hpp"

namespace ipos::signals {

enum class Group : uint8_t {
  Drive,           // speed, torque, status ...
  State,           // the states of plant files and tests
  Input,           // DI00
  Output,          // DO01
  Analog,          // AI1
  ProcessData,     // PO1
  Task,            // task1.line
  Variable,        // symbols and numbers
  SystemVariable,  // ActPos_Mot
  Parameter,       // P130
  Bus,             // sbus.load
};
std::string_view group_text(Group group);  // "inputs"

struct Signal {
  std::string name;   // "unit1.speed"
  std::string unit;   // of the number shown; empty: a plain number
  double factor = 1;  // number shown = sample x factor
  int decimals = 0;
  bool is_status = false;  // a plot shows its changes as events
  std::string station{};   // or bus; the name begins with it and a dot
  size_t bits = 0;         // width of a bit field, 1: on or off; 0: a number
  Group group = Group::Variable;
  std::string meaning{};
  std::function<int64_t()> read{};  // the sample of now; whose it is must still be there
  // Of what changes only where the drive decides (DriveWatcher): the same, of a drive that is up to date.
  int64_t (*decided)(const runtime::Drive&) = nullptr;

  std::string text(int64_t sample) const;  // "1500.000"
  void append_text(std::string& out, int64_t sample) const;
};

// All of a station but its parameters and the bits and numbers of what it has; a name stands for one thing: a program's
// own name hides the unit's.
std::vector<Signal> station_signals(const runtime::Station& station);

// What a name without the station's means: a signal of these, a value of the unit whatever the program calls its own
// ("drive.speed"), a parameter ("P130", "8807"), a variable ("H500", "TrCycl" for all its members), a bit ("PO1.6"). Empty
// when the station has no such thing.
std::vector<Signal> find_station_signals(const runtime::Station& station, std::string_view name);

// What a recording has where nobody names its signals: speed, setpoint and status of the unit, as far as it has them.
std::vector<Signal> default_signals(const runtime::Station& station);

// Names of the unit that the program has given to variables of its own: "speed".
std::vector<std::string> hidden_names(const runtime::Station& station);

// With a pattern: parameters and numbered variables only where it begins like one, bits where it has a dot.
std::vector<Signal> match_station_signals(const runtime::Station& station, std::string_view pattern);

// Bits of a bit field or of a variable, 0 of a number; and one of them as a signal, "unit1.PO1.6".
size_t bit_count(const Signal& signal);
Signal bit_of(const Signal& whole, size_t bit);

// By the whole name: one of these, or a bit of one. Those that a pattern fits, and their bits where it has a dot for them.
std::optional<Signal> find_among(std::span<const Signal> all, std::string_view name);
std::vector<Signal> match_among(std::span<const Signal> all, std::string_view pattern);
// "powered, exchange, ...", without the station's part.
std::string names_of(std::span<const Signal> all);

// "speed, ..., inputs as DI00, ...": for messages.
std::string station_signal_names(const runtime::Station& station);

// '*' stands for any letters, '?' for one; every other letter for itself.
bool is_pattern(std::string_view name);
bool matches(std::string_view pattern, std::string_view text);

}  // namespace ipos::signals
