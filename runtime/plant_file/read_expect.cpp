// [[expect]] of the plant file.
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

void read_expectation(PlantReader& reader, const toml::table& table) {
  constexpr std::string_view kWhat = "an [[expect]]";
  reader.known_keys(
      table, "[[expect]]",
      {"station", "at", "variable", "parameter", "input", "output", "state", "signal", "equals"});
  Expectation expected;
  expected.place = place_of(table);
  expected.signal.station = reader.station(table, kWhat, table.contains("signal"));
  reader.signal(table, kWhat, {"variable", "parameter", "input", "output", "state", "signal"},
                expected.signal);
  expected.at = reader.duration(table, "at", kWhat, true);
  const toml::node* equals = table.get("equals");
  if (equals != nullptr && expected.signal.kind == SignalKind::Parameter)
    reader.parameter_value(*equals, reader.unit_of(expected.signal.station), expected.signal.name,
                           expected.equals);
  else if (equals != nullptr)
    reader.number(*equals, "equals", expected.equals);
  else
    reader.error(expected.place, "an [[expect]] needs equals = ...");
  reader.result.plant.expectations.push_back(std::move(expected));
}

}  // namespace

void read_expectations(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "expect", [&](const toml::table& table) { read_expectation(reader, table); });
}

}  // namespace ipos::runtime
