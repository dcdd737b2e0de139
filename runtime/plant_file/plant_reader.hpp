// What the readers of the plant file's sections share: the result, the errors with their places, and the
// forms of values. Only the readers include this; it needs toml++.
#pragma once

#include <fmt/format.h>

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"
#include "runtime/plant_file/read_toml.hpp"
#include "runtime/plant_file/toml_sign.hpp"

namespace ipos::runtime {

// What an analog input is set to.
inline constexpr std::string_view kAnalogForms =
    "a text such as \"5 V\" (-10..10), \"12 mA\" (0..20), for frequency \"5 kHz\" (0..65), for potentiometer "
    "\"50 %\" (0..100)";

inline constexpr int64_t kShortest = 1'000'000;  // ns: nothing in a station is quicker than its tick

class PlantReader {
 public:
  static constexpr size_t kMostErrors = 100;  // ours
  PlantFileResult result;
  // Names given and names used; what is used and not given is an error at the end.
  std::set<std::string> bus_names;
  std::set<std::string> station_names;
  std::set<std::string> gateway_names;  // of the stations, those without anything to look at
  std::set<std::string> machine_names;
  std::set<std::string> port_names;
  std::set<std::string> nvram_files;
  std::vector<std::pair<BusUse, BusKind>> bus_uses;  // with the kind it must be of
  std::vector<std::pair<std::string, FilePlace>> station_uses;

  void error(FilePlace place, std::string text, std::optional<AllowedValues> allowed = std::nullopt) {
    if (result.errors.size() == kMostErrors)
      result.errors.push_back({place, "too many mistakes; the rest is not told", std::nullopt});
    if (result.errors.size() < kMostErrors) result.errors.push_back({place, std::move(text), std::move(allowed)});
  }

  // Every other key is an error. `what` names the table.
  void known_keys(const toml::table& table, std::string_view what, const std::vector<std::string_view>& keys);

  template <typename Action>
  void for_each_table(const toml::table& root, std::string_view key, Action action) {
    const toml::node* node = root.get(key);
    if (node == nullptr) return;
    const toml::array* tables = node->as_array();
    if (tables == nullptr) return error(place_of(*node), fmt::format("write [[{}]], one for each", key));
    for (const toml::node& entry : *tables) {
      if (const toml::table* table = entry.as_table())
        action(*table);
      else
        error(place_of(entry), fmt::format("write [[{}]], one for each", key));
    }
  }

  // [station.KEY], or nullptr.
  const toml::table* subtable(const toml::table& table, std::string_view key);

  // A text value, or an empty one; `required` makes absence an error. It is one line; lines() takes several.
  std::string text(const toml::table& table, std::string_view key, std::string_view what, bool required);
  std::string lines(const toml::table& table, std::string_view key, std::string_view what, bool required);
  // A 32-bit value; hexadecimal numbers may use all 32 bits.
  bool number(const toml::node& node, std::string_view what, int32_t& out);
  // The same with as many decimals as the signal of an expectation has, in units of the last one. expected_decimals() finds
  // how many: as many as the value with most of them among `keys`; a wrong one is told when it is read.
  bool expected_number(const toml::node& node, std::string_view what, const Signal& of, int64_t& out);
  static uint8_t expected_decimals(const toml::table& table, std::initializer_list<std::string_view> keys);
  // The value of a parameter of a unit: a number is the coding of the parameter channel, a text is what
  // people read: "2.5 s", "500 kBaud". False with an error, or when the unit is unknown.
  bool parameter_value(const toml::node& node, const stdlib::UnitType* unit, std::string_view parameter,
                       int32_t& out);
  bool refuse_decimal(const toml::value<double>& node, const stdlib::UnitType* unit, std::string_view parameter);
  // Of a station that has been read; nullptr when there is none of this name.
  const stdlib::UnitType* unit_of(std::string_view station) const;
  // Nothing when it is not there.
  std::optional<bool> flag(const toml::table& table, std::string_view key);
  // "off" or "on"; nothing with an error, or when it is not there.
  std::optional<bool> off_or_on(const toml::table& table, std::string_view key, std::string_view what);
  // A value without sign from `least` up to `limit`, or `otherwise`.
  uint32_t count(const toml::table& table, std::string_view key, uint32_t limit, uint32_t otherwise,
                 uint32_t least = 0);
  // "500ms" in ns, 0 when it is not there.
  int64_t duration(const toml::table& table, std::string_view key, std::string_view what, bool required);
  // The same, `otherwise` when it is not there and -1 with an error.
  int64_t duration(const toml::table& table, std::string_view key, int64_t otherwise);

  // The text of a key that names a station, which must be there. `gateway_too`: what is wanted of it a gateway has, too.
  std::string station(const toml::table& table, std::string_view what, bool gateway_too = false);
  std::string station_name(const toml::table& table, std::string_view key);  // may be absent
  // The bus a key names; it must be of this kind (a serial key takes both serial kinds).
  BusUse bus_use(const toml::table& table, std::string_view key, BusKind kind);
  std::string bus_name(const toml::table& table, std::string_view key, std::string_view what, bool required);
  void new_station(const std::string& name, FilePlace place) {
    unique(station_names, name, "station", place);
  }

  void unique(std::set<std::string>& names, const std::string& name, std::string_view what, FilePlace place);

  // A gateway where something of a station is wanted is an error.
  void use_station(const std::string& name, FilePlace place);

  // The one key of `kinds` that names a signal of the table's station; false with an error otherwise.
  bool signal(const toml::table& table, std::string_view what, std::initializer_list<std::string_view> kinds,
              Signal& out);
};

// The table of a TOML text; nothing with an error.
std::optional<toml::table> parse_toml(PlantReader& reader, std::string_view text);
// A file of another kind is told once, with the verb that takes it. True: it is of another kind.
bool refuse_others(PlantReader& reader, const toml::table& root, std::string_view path, std::initializer_list<TomlKind> taken);
// All sections of a plant but [[expect]]. `also` are keys of the root beside them, which the caller reads.
void read_plant_sections(PlantReader& reader, const toml::table& root,
                         const std::vector<std::string_view>& also);
// At the end: what the sections say of each other; the errors come into the order of the file.
void check_plant(PlantReader& reader);

// The sections, each with its own file.
void read_buses(PlantReader& reader, const toml::table& root);
void read_stations(PlantReader& reader, const toml::table& root);
void read_gateway(PlantReader& reader, const toml::table& table);
void read_machine(PlantReader& reader, const toml::table& station, StationConfig& config);
// [station.motor], unit_rating, control, brake and load: all of MachineData.
void read_motor(PlantReader& reader, const toml::table& station, StationConfig& config);
void read_encoders(PlantReader& reader, const toml::table& station, StationConfig& config);
void read_foreign_machines(PlantReader& reader, const toml::table& root);
// Of a [[switch]] with part_at, all but its input and its active level.
void read_barrier(PlantReader& reader, const toml::table& table, LightBarrier barrier);
void read_profibus_card(PlantReader& reader, const toml::table& table, StationConfig& config);
void read_cards(PlantReader& reader, const toml::table& table, StationConfig& config);
void read_profibus_master(PlantReader& reader, const toml::table& table, ControlConfig& control);
void read_fms_master(PlantReader& reader, const toml::table& table, ControlConfig& control);
void read_controls(PlantReader& reader, const toml::table& root);
// Of a [[control]] with kind = "canopen", all but what every control has.
canopen::MasterSettings read_canopen_master(PlantReader& reader, const toml::table& table);
void read_faults(PlantReader& reader, const toml::table& root);
void read_octet_fault(PlantReader& reader, const toml::table& table, BusKind line);  // of a bus of this kind
void read_surroundings(PlantReader& reader, const toml::table& root);  // stimulus, wire, switch; after the machines
void read_expectations(PlantReader& reader, const toml::table& root);

// Parts of them that a test file has, too. Signal, action and times of a stimulus, without station and `at`.
bool read_stimulus(PlantReader& reader, const toml::table& table, std::string_view what, Stimulus& stimulus);
void read_fault(PlantReader& reader, const toml::table& table);  // adds it to the result

}  // namespace ipos::runtime
