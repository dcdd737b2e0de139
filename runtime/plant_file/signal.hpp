// What of a station has a value that a plant file can name: variables, parameters, inputs, outputs, states, and
// any other signal (runtime/signals/find.hpp).
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/unit/unit_inputs.hpp"

namespace ipos::runtime {

enum class SignalKind : uint8_t { Variable, Parameter, Input, Output, State, Switch, Any };

struct Signal {
  std::string station;
  SignalKind kind = SignalKind::Variable;
  std::string name;  // as written: "lCount", "H10", "P301", "DI03", "AI1", "DO01", "fault"
  uint8_t line = 0;  // Input: see above; Output: bit of OutputLevel H482; State: row of station_states()
  uint8_t decimals = 0;  // Any: an expectation compares the number shown to so many, and its values count units of the last one
};

// The most decimals of an expectation, as many as a signal has that is shown with most.
inline constexpr uint8_t kMostDecimals = 6;
// 443 with 2 decimals is "4.43".
std::string decimal_text(int64_t value, int decimals);

struct BinaryTerminal {
  std::string_view name;
  uint8_t bit;
  std::string_view parameter;  // gives it its function; empty: it is fixed
};
std::span<const BinaryTerminal> binary_inputs();
std::span<const BinaryTerminal> binary_outputs();
std::string_view input_name(size_t line);  // "DI03", "AI1"

// "DI03" or "DI12": bit of InputLevel H483, or -1. DI00..DI07 are bits 0..7, DI10..DI17 bits 8..15 (ours).
int parse_input(std::string_view name);

// "DB00", "DO01".."DO05", "DO10".."DO17": bit of OutputLevel H482, or -1.
int parse_output(std::string_view name);

// "AI1", "AI2", "frequency", "potentiometer": the first line of the terminal, or -1.
int parse_analog_input(std::string_view name);

// AI1 and AI2 have a line for a voltage and one for a current; every other terminal has one.
bool same_terminal(size_t line, size_t other);

// The lines of analog terminals, in their order.
struct AnalogKind {
  std::string_view name;    // of the terminal
  std::string_view signal;  // of the line: of an input for voltage and current each has its own
  std::string_view unit;
  double factor;  // value = amount in the unit x factor
  double minimum;
  double maximum;
  AnalogLine line;
  enum class Units : uint8_t { All, Movitrac07, Others } units;

  bool is_of(const stdlib::UnitType& unit) const;
};
std::span<const AnalogKind> analog_kinds();

constexpr uint8_t line_of(const AnalogKind& kind) {
  return static_cast<uint8_t>(kBinaryLines + static_cast<size_t>(kind.line));
}

// What hangs on an analog terminal: "AI1", "5 V".
struct AnalogSetting {
  uint8_t line = 0;
  int32_t value = 0;  // mV, uA, Hz, 1/1000
};
std::optional<AnalogSetting> parse_analog(std::string_view name, std::string_view text);

}  // namespace ipos::runtime
