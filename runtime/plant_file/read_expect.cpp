// [[expect]] of the plant file.
#include <algorithm>

#include "runtime/plant_file/expect_keys.hpp"
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

void read_expectation(PlantReader& reader, const toml::table& table) {
  constexpr std::string_view kWhat = "an [[expect]]";
  // What only tests look at is theirs: the plant is the same without it.
  const auto of_test = [&](std::string_view key) { return table.contains(key); };
  const bool at_end = table["at"].value_or(std::string()) == "end";
  if (at_end || std::any_of(kTestExpectKeys.begin(), kTestExpectKeys.end(), of_test)) {
    std::vector<std::string_view> known = kExpectKeys;
    known.insert(known.end(), kTestExpectKeys.begin(), kTestExpectKeys.end());
    reader.known_keys(table, "[[expect]]", known);
    ++reader.result.plant.expectations_of_tests;
    return;
  }
  reader.known_keys(table, "[[expect]]", kExpectKeys);
  Expectation expected;
  expected.place = place_of(table);
  expected.signal.station = reader.station(table, kWhat, table.contains("signal"));
  reader.signal(table, kWhat, {"variable", "parameter", "input", "output", "state", "signal"},
                expected.signal);
  expected.at = reader.duration(table, "at", kWhat, true);
  const toml::node* equals = table.get("equals");
  if (expected.signal.kind == SignalKind::Any) expected.signal.decimals = PlantReader::expected_decimals(table, {"equals"});
  if (int32_t value = 0; equals != nullptr && expected.signal.kind == SignalKind::Parameter &&
                         reader.parameter_value(*equals, reader.unit_of(expected.signal.station), expected.signal.name, value))
    expected.equals = value;
  else if (equals != nullptr && expected.signal.kind != SignalKind::Parameter)
    reader.expected_number(*equals, "equals", expected.signal, expected.equals);
  else if (equals == nullptr)
    reader.error(expected.place, "an [[expect]] needs equals = ...");
  reader.result.plant.expectations.push_back(std::move(expected));
}

}  // namespace

void read_expectations(PlantReader& reader, const toml::table& root) {
  reader.for_each_table(root, "expect", [&](const toml::table& table) { read_expectation(reader, table); });
}

}  // namespace ipos::runtime
