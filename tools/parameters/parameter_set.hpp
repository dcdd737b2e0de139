// The settings of a unit as a file that diffs well: TOML, a line a parameter (docs/guide/param.md). Nothing in it
// depends on how the unit was reached.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant_file/toml_text.hpp"
#include "stdlib/parameters.hpp"
#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools {

struct SetRow {
  const stdlib::Parameter* parameter;
  int32_t value;
  runtime::FilePlace place;  // of a row that was read from a file
};

struct ParameterSet {
  const stdlib::UnitType* unit = nullptr;
  std::vector<SetRow> rows;
};

// "P130 Ramp t11 UP CW := 2.500 s: parameter lock is active (P803 = ON)"
std::string why(const stdlib::ParameterTable& table, stdlib::Service service, uint16_t index, int32_t value,
                const AccessError& error);

// Prints a refusal, with a place in front ("file:1:2: "); a unit that does not answer ends the verb.
void print_refusal(const ParameterAccess& access, stdlib::Service service, uint16_t index, int32_t value,
                   const AccessError& error, const std::string& place = "");

// Reads all settings: what is written and kept by the unit. One that is refused is printed and left out, and
// `complete` becomes false; a unit that does not answer is a Failure.
ParameterSet read_settings(ParameterAccess& access, bool& complete);

// What came of writing a row of a set.
struct WrittenRow {
  enum class Outcome : uint8_t { Unchanged, Written, Refused };
  SetRow row;
  Outcome outcome = Outcome::Unchanged;
  bool unlocks = false;     // takes the lock off: not of the set
  stdlib::Service service;  // that was refused
  AccessError error;
};
// Writes what differs, in the order of docs/guide/param.md: a lock comes off first and is on again at the end. Ends
// with a unit that does not answer; that row is the last one.
std::vector<WrittenRow> write_settings(ParameterAccess& access, const ParameterSet& set,
                                       stdlib::Service service);

std::string to_text(const ParameterSet& set);

// The file says itself what it is.
bool is_parameter_set(std::string_view text);
// The errors with their places: "mine.settings:1:2: error: ...".
tl::expected<ParameterSet, std::vector<std::string>> read_parameter_set(const std::string& path,
                                                                        std::string_view text);
// Errors are printed, then a Failure ends the verb.
ParameterSet parse_settings(const std::string& path, std::string_view text);

}  // namespace ipos::tools
