// The one reading of names. Signals of a station are "unit1.speed", those of a bus "sbus.load"; names may be patterns:
// "unit1.D*" are all its binary inputs and outputs. A program's own name hides a value of the unit that is called the same,
// as an inner scope does; "drive.NAME" is always the unit's.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/plant_file/plant_file.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/signal.hpp"
#include "runtime/station/plant_parts.hpp"

namespace ipos::signals {

// A station whose signals are found: where it may be changed, they can be written.
struct Owner {
  Owner(const runtime::Station& looked_at) : station(looked_at) {}
  Owner(runtime::Station& changed) : station(changed), to_write(&changed) {}
  const runtime::Station& station;
  runtime::Station* to_write = nullptr;
};

// --- of a station ---

// All of a station except its parameters and the bits and numbers of what it has; a name stands for one thing.
std::vector<Signal> station_signals(Owner owner);

// What a name without the station's means: a signal of these, a value of the unit whatever the program calls its own
// ("drive.speed"), a parameter ("P130", "8807"), a variable ("H500", "TrCycl" for all its members), a bit ("PO1.6"). Empty
// when the station has no such thing.
std::vector<Signal> find_station_signals(Owner owner, std::string_view name);

// With a pattern: parameters and numbered variables only where it begins like one, bits where it has a dot.
std::vector<Signal> match_station_signals(Owner owner, std::string_view pattern);

// What a recording has where nobody names its signals: speed, setpoint and status of the unit, as far as it has them.
std::vector<Signal> default_signals(Owner owner);

// Names of the unit that the program has given to variables of its own: "speed".
std::vector<std::string> hidden_names(const runtime::Station& station);

// Whether a unit of this kind has a value of its own that is called so.
bool is_unit_value(const stdlib::UnitType& unit, std::string_view name);

// All of one group, by the names that it has there: among them the states that a value of the drive hides otherwise.
std::vector<Signal> signals_of(Owner owner, Group group);
// One of a group by its name: of variables also a number, a system variable, and of a whole the first one.
std::optional<Signal> find_in_group(Owner owner, Group group, std::string_view name);
// By its number in the group.
std::optional<Signal> signal_at(Owner owner, Group group, uint32_t number);

// Of the two lines of an analog input, for a voltage and for a current, the one that was set last.
Signal live_line(const Signal& analog);

// --- of a plant, which must outlive them ---

std::vector<Signal> plant_signals(const runtime::PlantParts& plant);

// What a name or pattern stands for, at least one signal; else why it stands for none. With one station its
// name may be left out.
tl::expected<std::vector<Signal>, std::string> find_signals(const runtime::PlantParts& plant, std::string_view name);

// What a plant file names; nothing and why when a station or gateway has no such thing. `why` stays empty where there is
// no such station, which the reader of the file has told.
std::optional<Signal> find_signal(const runtime::PlantParts& plant, const runtime::Signal& named, std::string& why);
// What a stimulus acts on. Where it names a signal of any kind, its value is read here, as only the signal knows its unit.
std::optional<Signal> find_target(const runtime::PlantParts& plant, runtime::Stimulus& stimulus, std::string& why);

// What an expectation on it compares: of `signal = ...` the number shown, rounded to the decimals of the expectation; of
// `state = ...` and the others the sample.
int64_t value_for(const runtime::Signal& named, const Signal& signal);

// --- among some ---

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
