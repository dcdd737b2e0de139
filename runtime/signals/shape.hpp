// How a signal is drawn: as a curve, as a lane that is high while it is on, as a lane a bit, or as a strip of words. Told by
// the signal itself, so that the scope of the page, plots and reports show the same. Which bits and values have words
// stands in the tables of the units.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "runtime/signals/signal.hpp"

namespace ipos::signals {

struct Shape {
  enum class Kind : uint8_t {
    Curve,  // a number
    Level,  // on or off
    Word,   // bits; what they say together stands in `texts`
    Words,  // a choice: each value has a text, or is shown as a number
  };
  Kind kind = Kind::Curve;
  std::vector<std::pair<unsigned, std::string>> bits{};  // of a word, in rising order; empty: no bit has a name
  std::vector<std::pair<int64_t, std::string>> texts{};  // of the sample & `mask`
  int64_t mask = -1;
};

std::string_view kind_text(Shape::Kind kind);  // "curve"

Shape shape_of(const Signal& signal);

}  // namespace ipos::signals
