// A key that nobody knows is shown to the readers, and values that cannot be: they answer with what there is.
#include "tools/serve/host/plant_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <vector>

#include "runtime/plant_file/plant_file.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/station/sbus_port.hpp"
#include "stdlib/parameters.hpp"
#include "tools/serve/host/step_text.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::PlantError;
using runtime::PlantFile;
using runtime::StationConfig;

constexpr std::string_view kNobody = "ipos_probe";
constexpr std::string_view kTables[] = {"station", "bus", "wire", "control"};

std::string table_of(const Arguments& a) {
  const std::string table = a.text("table");
  if (std::find(std::begin(kTables), std::end(kTables), table) == std::end(kTables))
    throw Mistake("'table' must be station, bus, wire or control");
  return table;
}

// What the readers say of the last row of a text.
std::vector<PlantError> errors_of_last(const std::string& text) {
  const auto rows = static_cast<uint32_t>(std::count(text.begin(), text.end(), '\n'));
  std::vector<PlantError> errors = runtime::read_plant_file(text).errors;
  std::erase_if(errors, [rows](const PlantError& error) { return error.place.line != rows; });
  return errors;
}

// "...; known are a, b, c".
std::vector<std::string> words_in(const std::vector<PlantError>& errors) {
  constexpr std::string_view kKnown = "known are ";
  std::vector<std::string> words;
  for (const PlantError& error : errors) {
    if (error.allowed && !error.allowed->each.empty()) return error.allowed->each;
    const size_t at = error.text.find(kKnown);
    if (at == std::string::npos || error.text.find(kNobody) == std::string::npos) continue;
    std::string_view list = std::string_view(error.text).substr(at + kKnown.size());
    while (!list.empty()) {
      const size_t comma = std::min(list.find(", "), list.size());
      words.emplace_back(list.substr(0, comma));
      list.remove_prefix(std::min(comma + 2, list.size()));
    }
    break;
  }
  return words;
}

// Rows of a table of which this is the form: that of a station differs with its unit.
std::string head_of(const std::string& table, const Arguments& a) {
  std::string head = fmt::format("[[{}]]\n", table);
  if (table == "station") head += toml_row("name", kNobody) + toml_row("unit", a.text("unit", "mdxb"));
  if (table == "control") head += toml_row("name", kNobody);
  return head;
}

std::string free_name(const std::set<std::string>& taken, std::string_view begin) {
  for (int n = 1;; ++n)
    if (std::string name = fmt::format("{}{}", begin, n); !taken.contains(name)) return name;
}

int32_t set_value(const StationConfig& station, const stdlib::Parameter& row) {
  for (const runtime::ParameterSetting& setting : station.parameters)
    if (stdlib::parameter_table(*station.unit).find(setting.parameter) == &row) return setting.value;
  return static_cast<int32_t>(row.default_value);
}

const stdlib::Parameter* parameter_of(const StationConfig& station, std::string_view number) {
  return station.unit == nullptr || number.empty() ? nullptr : stdlib::parameter_table(*station.unit).find(number);
}

// The first address that no station has on that line.
int first_free(const std::set<int>& taken) {
  int address = 1;
  while (taken.contains(address)) ++address;
  return address;
}

// What a station of this unit needs so that it is heard on a line.
Json line_settings(const PlantFile& plant, const stdlib::UnitType& unit, const std::string& key, const runtime::BusConfig& bus) {
  Json parameters = Json::array();
  Json values = Json::object();
  std::set<int> taken;
  const auto set = [&](std::string_view number, const std::string& text, bool always) {
    const stdlib::Parameter* row = stdlib::parameter_table(unit).find(number);
    if (row == nullptr) return;
    const auto value = stdlib::parse_parameter_text(*row, text);
    if (value && (always || *value != static_cast<int32_t>(row->default_value)))
      parameters.push_back({{"number", fmt::format("P{}", row->number)}, {"name", row->name}, {"value", stdlib::parameter_text(*row, *value)}});
  };
  if (bus.kind == runtime::BusKind::Can) {
    const int sbus = key == "sbus2" ? 2 : 1;
    for (const StationConfig& other : plant.stations)
      for (const int number : {1, 2})
        if (other.unit != nullptr && (number == 1 ? other.sbus : other.sbus2) == bus.name)
          if (const auto* row = parameter_of(other, runtime::sbus_numbers(*other.unit, number).address))
            taken.insert(set_value(other, *row));
    const runtime::SbusNumbers& numbers = runtime::sbus_numbers(unit, sbus);
    set(numbers.address, std::to_string(first_free(taken)), true);
    if (const auto* row = stdlib::parameter_table(unit).find(numbers.baud))
      for (size_t n = 0; n < runtime::kBaudRates.size(); ++n)
        if (runtime::kBaudRates[n] == bus.baud) set(numbers.baud, stdlib::parameter_text(*row, static_cast<int32_t>(n)), false);
  } else if (bus.kind == runtime::BusKind::Profibus) {
    for (const StationConfig& other : plant.stations)
      if (other.profibus.bus.bus == bus.name) taken.insert(other.profibus.address);
    values["profibus_address"] = std::max(first_free(taken), 2);  // 1 is the master, where nobody says otherwise
  } else {
    for (const StationConfig& other : plant.stations)
      if (other.serial.x13.bus == bus.name || other.serial.xt.bus == bus.name)
        if (const auto* row = parameter_of(other, "810")) taken.insert(set_value(other, *row));
    set("810", std::to_string(first_free(taken)), true);
  }
  return {{"key", key}, {"bus", bus.name}, {"parameters", std::move(parameters)}, {"values", std::move(values)}};
}

bool names_a_bus(const std::vector<PlantError>& errors) {
  return std::any_of(errors.begin(), errors.end(),
                     [](const PlantError& error) { return error.text.find("no bus ") != std::string::npos; });
}

Json lines_of(const std::string& text, const PlantFile& plant, const std::string& head, const Json& keys,
              const stdlib::UnitType& unit) {
  Json lines = Json::array();
  for (const Json& row : keys) {
    const std::string key = row["key"];
    if (!names_a_bus(errors_of_last(head + toml_row(key, kNobody)))) continue;
    for (const runtime::BusConfig& bus : plant.buses) {
      std::vector<PlantError> errors = errors_of_last(text + "\n" + head + toml_row(key, bus.name));
      // What else the line needs comes with the settings.
      std::erase_if(errors, [](const PlantError& error) { return error.text.find(" needs ") != std::string::npos; });
      if (errors.empty()) lines.push_back(line_settings(plant, unit, key, bus));
    }
  }
  return lines;
}

Json terminals(const PlantFile& plant, std::span<const runtime::BinaryTerminal> all) {
  Json names = Json::array();
  for (const StationConfig& station : plant.stations)
    for (const runtime::BinaryTerminal& terminal : all)
      names.push_back(fmt::format("{}.{}", station.name, terminal.name));
  return names;
}

}  // namespace

Json plant_form(const std::string& text, const Arguments& a) {
  const std::string table = table_of(a);
  const PlantFile plant = runtime::read_plant_file(text).plant;
  const std::string head = head_of(table, a);
  Json keys = Json::array();
  for (const std::string& key : words_in(errors_of_last(head + fmt::format("{} = 1\n", kNobody)))) {
    if (head.find(fmt::format("\n{} = ", key)) != std::string::npos) continue;
    keys.push_back({{"key", key}, {"words", words_in(errors_of_last(head + toml_row(key, kNobody)))}});
  }
  Json form{{"keys", keys}};
  std::set<std::string> taken;
  for (const StationConfig& station : plant.stations) taken.insert(station.name);
  for (const runtime::BusConfig& bus : plant.buses) taken.insert(bus.name);
  for (const runtime::ControlConfig& control : plant.controls) taken.insert(control.name);
  form["name"] = free_name(taken, table == "station" ? "unit" : table);
  if (table == "station") {
    form["units"] = words_in(errors_of_last(fmt::format("[[station]]\n{}{}", toml_row("name", kNobody), toml_row("unit", kNobody))));
    const stdlib::UnitType* unit = stdlib::find_unit(a.text("unit", "mdxb"));
    form["runs_programs"] = unit != nullptr && unit->runs_programs();
    form["lines"] = unit == nullptr ? Json::array() : lines_of(text, plant, head, keys, *unit);
  }
  if (table == "wire") {
    form["from"] = terminals(plant, runtime::binary_outputs());
    form["to"] = terminals(plant, runtime::binary_inputs());
  }
  return form;
}

std::string with_table(const std::string& text, const Arguments& a) {
  const std::string table = table_of(a);
  std::string added = fmt::format("[[{}]]\n", table);
  const auto members = [&](const char* key) { return a.has(key) ? a.json()[key] : Json::object(); };
  const auto is_key = [](const std::string& key) {
    return !key.empty() && key.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
  };
  const auto value = [](const Json& json) { return json.is_string() ? toml_text(json.get<std::string>()) : json.dump(); };
  const Json values = members("values");
  for (const auto& [key, json] : values.items()) {
    if (!is_key(key)) throw Mistake(fmt::format("'{}' is no key", key));
    added += fmt::format("{} = {}\n", key, value(json));
  }
  const Json written = members("written");
  for (const auto& [key, json] : written.items()) {
    const std::string row = json.is_string() ? json.get<std::string>() : json.dump();
    if (!is_key(key) || row.find('\n') != std::string::npos) throw Mistake(fmt::format("'{}' is one line", key));
    added += fmt::format("{} = {}\n", key, row);
  }
  if (const Json parameters = members("parameters"); !parameters.empty()) {
    added += fmt::format("[{}.parameters]\n", table);
    for (const auto& [key, json] : parameters.items()) {
      if (!is_key(key)) throw Mistake(fmt::format("'{}' is no parameter", key));
      added += fmt::format("{} = {}\n", key, value(json));
    }
  }
  std::string all = text;
  if (!all.empty() && !all.ends_with('\n')) all += '\n';
  if (!all.empty()) all += '\n';
  const auto begins = static_cast<uint32_t>(std::count(all.begin(), all.end(), '\n')) + 1;
  all += added;
  // What was wrong before is not the fault of the new table.
  std::string why;
  for (const PlantError& error : runtime::read_plant_file(all).errors)
    if (error.place.line >= begins) why += (why.empty() ? "" : "\n") + error.text;
  if (!why.empty()) throw Mistake(why);
  return all;
}

}  // namespace ipos::tools::serve
