// A value of a station, line or gateway that has a name: what every front end reads, shows, parses, writes and holds. It is
// found by its name once (find.hpp) and read as often as wanted. docs/guide/recording.md has the names.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

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

// Why something was not done; nothing when it was.
using Refusal = std::optional<std::string>;

// Of the samples that can be written at all.
struct Limits {
  int64_t least = INT32_MIN;
  int64_t most = INT32_MAX;
};

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
  std::function<int64_t()> read{};  // the sample of now; its owner must still be there
  // Of what changes only where the drive decides (DriveWatcher): the same, of a drive that is up to date.
  int64_t (*decided)(const runtime::Drive&) = nullptr;

  // What it is in its group: a variable, the index of a parameter, the line of an input, the bit of an output, the row of
  // a state, a word.
  uint32_t number = 0;
  const stdlib::Parameter* parameter = nullptr;  // of the group: its words and whether it can be set
  Limits limits{};
  // Writes a sample; null where it can only be read.
  using Put = Refusal (*)(runtime::Station& station, uint32_t number, int32_t sample);
  Put put = nullptr;
  runtime::Station* owner = nullptr;  // null: found in a station that is only looked at

  std::string text(int64_t sample) const;  // "1500.000"
  void append_text(std::string& out, int64_t sample) const;
  // With its unit, or in the words of a parameter: "1500.000 rpm", "2.5 s".
  std::string words(int64_t sample) const;
  // The number shown, rounded to so many digits behind the point and counted in units of the last one: what expectations and expressions
  // compare.
  int64_t rounded(int digits = 0) const;
  std::string_view own_name() const;  // without the station's part

  bool is_variable() const { return group == Group::Variable || group == Group::SystemVariable; }
  bool is_input() const { return group == Group::Input || group == Group::Analog; }
  // A person can set it; of parameters also the unit says so.
  bool is_writable() const { return put != nullptr && owner != nullptr && (parameter == nullptr || parameter->writable); }
  // Why a sample cannot be one of it at all.
  Refusal check(int64_t sample) const;
  // A variable or parameter is written as over the parameter channel, volatile; an input gets this level; a process
  // output word comes as over the bus that P101 names, or P100, or else the SBus.
  Refusal write(int64_t sample) const;
  // Of an input: what hangs on its terminal.
  runtime::InputLine& line() const { return owner->inputs().line(number); }

  // The sample that a text stands for. Of an analog input a voltage or a current: then it is another line's.
  struct Parsed {
    uint32_t number;
    int64_t sample;
  };
  tl::expected<Parsed, std::string> parse(std::string_view text) const;

  bool same_as(const Signal& other) const {
    return put == other.put && owner == other.owner && number == other.number;
  }
  // The same, or the other line of an analog input.
  bool shares_terminal(const Signal& other) const;
};

// Bits of a bit field or of a variable, 0 of a number; and one of them as a signal, "unit1.PO1.6".
size_t bit_count(const Signal& signal);
Signal bit_of(const Signal& whole, size_t bit);

}  // namespace ipos::signals
