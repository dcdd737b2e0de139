// What an FMU of a plant has: variables made of signals. The tool that writes the description and the library that answers for it
// make the same list of the same plant, so a value reference is a place in it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/find.hpp"
#include "runtime/signals/physical_units.hpp"

namespace ipos::fmi {

enum class Type : uint8_t { Real, Integer, Boolean, Enumeration };
enum class Causality : uint8_t { Input, Output, Parameter, Local };

struct Variable {
  std::string name;  // structured
  std::string description;
  Type type = Type::Real;
  Causality causality = Causality::Local;
  bool is_continuous = false;  // of Real: it may be interpolated
  double per_sample = 1;       // of Real: value = sample x this
  std::string unit;            // of Real: a name of Variables::units; empty: none
  std::optional<std::pair<int64_t, int64_t>> range;  // of samples
  std::optional<size_t> enumeration;                 // in Variables::enumerations
  signals::Signal signal;

  bool is_settable() const { return causality == Causality::Input || causality == Causality::Parameter; }
  double value_of(int64_t sample) const { return static_cast<double>(sample) * per_sample; }
};

struct Enumeration {
  std::string name;
  std::vector<std::pair<int32_t, std::string>> items;  // each value and each text once
};

struct Variables {
  std::vector<Variable> all;  // that of value reference n + 1 is all[n]; reference 0 is the time
  std::vector<Enumeration> enumerations;
  std::vector<runtime::PhysicalUnit> units;  // each that a variable names
};

// A CAN line of the plant without its stations, with terminals for other people's nodes.
struct LineChoice {
  std::string bus;
  uint32_t terminals = 2;
};
inline constexpr uint32_t kMostTerminals = 64;  // ours

// What goes into an FMU.
struct Choice {
  std::vector<std::string> stations;  // their names; empty: all
  std::vector<std::string> signals;   // names and patterns: outputs beside the usual ones
  std::optional<LineChoice> line{};   // instead of the plant
};

// The error says which name of the choice stands for nothing.
tl::expected<Variables, std::string> variables_of(runtime::Plant& plant, const Choice& choice);

}  // namespace ipos::fmi
