// What of a station can be named, found by kind and name: how it is read, written, forced, and shown to people. Signals that
// can only be read (kind Signal) are those of station_signals.hpp; their reader stays with the session.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/plant/hands.hpp"
#include "runtime/signals/station_signals.hpp"

namespace ipos::library {

using runtime::Station;

// As ipos_plant_kind.
enum class Kind : uint8_t { Any, Variable, Parameter, Input, Output, Analog, State, Word, Signal };

// Which signal: plain numbers, so that a record of what was done can hold it.
struct Place {
  uint32_t station = 0;
  Kind kind = Kind::Variable;
  uint32_t number =
      0;  // variable; index of a parameter; bit of a terminal; first line of an analog input; row of
          // station_states(); word PO1..PO3, PI1..PI3
  bool operator==(const Place&) const = default;
};

struct PlaceInfo {
  std::string name;
  std::string_view unit{};
  double factor = 1;
  int decimals = 0;
  bool writable = false;
};

// Gateways are numbered behind the stations with a drive. They have power and signals, which can only be read.
size_t station_count(const runtime::Plant& plant);
runtime::Gateway* gateway_of(const runtime::Plant& plant, uint32_t station);  // nullptr: it is none
std::string station_names(const runtime::Plant& plant);                       // "saw, feed"
// What a place of the kind Signal shows, as find_place has found it.
signals::Signal shown_signal(const runtime::Plant& plant, const Place& place, std::string_view name);

// The error says what there is instead.
tl::expected<Place, std::string> find_place(runtime::Plant& plant, uint32_t station, Kind kind,
                                            std::string_view name);
// What the station has of this kind; of variables those of the program, member by member, or only the members of the whole
// `part`.
std::vector<std::string> place_names(const runtime::Plant& plant, uint32_t station, Kind kind,
                                     std::optional<std::string_view> part = std::nullopt);

// Nothing when the station has no such place: numbers may come from anywhere.
bool exists(const runtime::Plant& plant, const Place& place);

PlaceInfo place_info(const runtime::Plant& plant, const Place& place, std::string_view name);
int64_t read_place(const runtime::Plant& plant, const Place& place);
std::string place_text(const runtime::Plant& plant, const Place& place);

// The value a text stands for at this place; the error says what would be accepted. An analog input may change to another
// line: voltage or current.
struct TextValue {
  Place place;
  int64_t value;
};
tl::expected<TextValue, std::string> parse_place_text(const runtime::Plant& plant, const Place& place,
                                                      std::string_view text);
// Why the value cannot be one of this place at all; nothing when it can.
runtime::Refusal check_value(const runtime::Plant& plant, const Place& place, int64_t value);
bool is_writable(const Place& place);

enum class Touch : uint8_t { Write, Force, Release };
runtime::Refusal do_to_place(runtime::Plant& plant, runtime::Hands& hands, const Place& place, Touch touch,
                             int64_t value);

}  // namespace ipos::library
