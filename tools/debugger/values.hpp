// What of a plant has a value that a person can name: every signal (runtime/signals), and a few of the debugger's own. Names
// of one station; "unit2.H5" is that of another. Numbers are those that signals show, in rpm; of parameters those that the
// parameter channel carries, with the words of the unit after them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/signal.hpp"
#include "runtime/signals/variables.hpp"

namespace ipos::tools::debug {

// A name or an expression that makes no sense, for the user.
class ValueError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct ValuePlace {
  uint32_t station = 0;
  uint32_t elements = 1;  // of an array
  std::string name;       // as shown
  // Of the plant that runs; it is found again in the next one.
  std::shared_ptr<const signals::Signal> signal{};
};

// Nothing when the plant has no such name.
std::optional<ValuePlace> find_value(const runtime::Plant& plant, uint32_t station, std::string_view name);
// H of this number under a name of its own; nothing when the station has none.
std::optional<ValuePlace> variable_place(const runtime::Plant& plant, uint32_t station, uint32_t number,
                                         std::string name);
// The same place in a plant that was made again.
ValuePlace find_again(const runtime::Plant& plant, const ValuePlace& place);
int32_t read_value(const ValuePlace& place);
// Throws ValueError when it is refused.
void write_value(const ValuePlace& place, int32_t value);

// "2000" or "0x7d0".
std::string number_text(int32_t value, bool hex);
// The same, with the unit, "300.000 rpm", of a parameter "2500 (2.500 s)".
std::string value_text(const ValuePlace& place, int32_t value, bool hex = false);
// Of what is there now: with the digits that a rounded value has lost.
std::string value_text(const ValuePlace& place, bool hex = false);

// A structure, an array or an array of structures: what a name of several variables stands for.
struct Whole {
  uint32_t station = 0;
  std::string name;  // without the station
  std::vector<signals::NamedVariable> variables;
};
std::optional<Whole> find_whole(const runtime::Plant& plant, uint32_t station, std::string_view name);
// "{1, 2, 3}", the first of many.
std::string whole_text(const runtime::Plant& plant, const Whole& whole, bool hex);

// What the expression names: a variable, an element, H[..], *420, a parameter... Throws ValueError, also for an array,
// which is no one value, unless its first element is wanted of it.
ValuePlace evaluate_place(const runtime::Plant& plant, uint32_t station, std::string_view text,
                          bool first_of_array = false);
// Operators of C on 32-bit numbers, names as above, `hits` where a breakpoint counts. Throws ValueError.
int32_t evaluate(const runtime::Plant& plant, uint32_t station, std::string_view text,
                 std::optional<int32_t> hits = {});
// What a person wants to be there: an expression, what value_text() shows of a parameter, or its words ("2.5 s").
int32_t evaluate_for(const runtime::Plant& plant, uint32_t station, const ValuePlace& place,
                     std::string_view text);

}  // namespace ipos::tools::debug
