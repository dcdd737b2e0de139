// Collects signals of a station, group by group; each group's source has its add_...(). What the unit calls as the program
// calls a variable gets the prefix "drive.".
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_set>
#include <utility>
#include <vector>

#include "runtime/signals/find.hpp"

namespace ipos::signals {

inline constexpr std::string_view kUnitPrefix = "drive.";
inline constexpr size_t kWordBits = 16, kLongBits = 32;

class Collector {
 public:
  explicit Collector(Owner owner) : owner_(owner) {}

  const runtime::Station& station() const { return owner_.station; }

  Signal& add(Group group, std::string_view name, std::string_view meaning, std::function<int64_t()> read);
  Signal& add_parameter(const stdlib::Parameter& row, Group group, std::string_view name);
  Signal& add_variable(Group group, std::string_view name, uint32_t number, std::string_view meaning);

  std::vector<Signal> found;

 private:
  Owner owner_;
  std::unordered_set<std::string> names_;
};

void add_symbols(Collector& out);
void add_system_variables(Collector& out);
void add_parameters(Collector& out);
void add_inputs(Collector& out);
void add_outputs(Collector& out);
void add_analog(Collector& out);
void add_states(Collector& out);
void add_states_beside_drive(Collector& out);  // without those that a value of the drive has the name of
std::optional<Signal> state_signal(Owner owner, std::string_view name);  // one of them
void add_card(Collector& out);  // lamps and switches, among the states
void add_words(Collector& out);
void add_drive_values(Collector& out);
void add_tasks(Collector& out);

// Null where the unit has no such parameter: "P130", "130", "8807".
const stdlib::Parameter* find_parameter(const stdlib::UnitType& unit, std::string_view number);

// The name of a value of the drive, whether or not this unit has it.
bool is_drive_value(std::string_view name);

// How each group is written.
Refusal write_variable(runtime::Station& station, uint32_t number, int32_t value);
Refusal write_parameter(runtime::Station& station, uint32_t index, int32_t value);
Refusal set_input(runtime::Station& station, uint32_t line, int32_t level);
Refusal set_switch(runtime::Station& station, uint32_t which, int32_t value);
Refusal set_word(runtime::Station& station, uint32_t word, int32_t value);

}  // namespace ipos::signals
