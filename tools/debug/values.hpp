// What of a plant has a value that a person can name: variables by symbol, number or system name, parameters,
// inputs, outputs, every other signal (station_signals.hpp), and a few of the debugger's own. Names of one
// station; "unit2.H5" is that of another.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "runtime/plant/plant.hpp"
#include "runtime/plant/station_signals.hpp"

namespace ipos::tools::debug {

// A name or an expression that makes no sense, for the user.
class ValueError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class ValueKind : uint8_t { Variable, Parameter, Input, Output, Time, Fault, Signal };

struct ValuePlace {
  uint32_t station = 0;
  ValueKind kind = ValueKind::Variable;
  uint32_t number = 0;    // of the variable; index of the parameter; line or bit
  uint32_t elements = 1;  // of an array
  std::string name;       // as shown
  std::shared_ptr<const runtime::PlantSignal> signal{};
};

// Nothing when the plant has no such name.
std::optional<ValuePlace> find_value(const runtime::Plant& plant, uint32_t station, std::string_view name);
int32_t read_value(const runtime::Plant& plant, const ValuePlace& place);
// Throws ValueError when it is refused.
void write_value(runtime::Plant& plant, const ValuePlace& place, int32_t value);

// "2000", of a parameter "2500 (2.500 s)".
std::string value_text(const runtime::Plant& plant, const ValuePlace& place, int32_t value);

// What the expression names: a variable, an element, H[..], a parameter... Throws ValueError.
ValuePlace evaluate_place(const runtime::Plant& plant, uint32_t station, std::string_view text);
// Operators of C on 32-bit numbers, names as above, `hits` where a breakpoint counts. Throws ValueError.
int32_t evaluate(const runtime::Plant& plant, uint32_t station, std::string_view text,
                 std::optional<int32_t> hits = {});

}  // namespace ipos::tools::debug
