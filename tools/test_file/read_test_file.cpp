// A test file: its plant, its items in their order, and its cases. A case replaces "$name" by its value in
// the text of the file, before it is read: so every key can be of a case, and lines stay what they are.
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "runtime/plant_file/expect_keys.hpp"
#include "runtime/plant_file/outer_port.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/text_lines.hpp"
#include "tools/test_file/item_reader.hpp"
#include "tools/test_file/read_tests.hpp"

namespace ipos::tools::testing {
namespace {

namespace fs = std::filesystem;

struct CaseValue {
  std::string name;
  std::string toml;   // as TOML writes it
  std::string plain;  // the characters of a text, else the same
};
struct Case {
  std::string name;
  std::vector<CaseValue> values;
  FilePlace place;
};

CaseValue case_value(std::string_view name, const toml::node& node) {
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  const auto* text = node.as_string();
  return {std::string(name), out.str(), text == nullptr ? out.str() : text->get()};
}

std::vector<Case> read_cases(PlantReader& reader, const toml::table& root) {
  std::vector<Case> cases;
  reader.for_each_table(root, "case", [&](const toml::table& table) {
    Case one{std::to_string(cases.size() + 1), {}, place_of(table)};
    if (table.contains("name")) one.name = reader.text(table, "name", "a [[case]]", true);
    one.values.push_back(case_value("name", toml::value<std::string>(one.name)));
    for (const auto& [key, node] : table) {
      if (node.is_table() || node.is_array_of_tables())
        reader.error(place_of(node), "a [[case]] has names and values");
      else if (key.str() != "name")
        one.values.push_back(case_value(key.str(), node));
    }
    cases.push_back(std::move(one));
  });
  return cases;
}

FilePlace place_at(const std::string& text, size_t offset) {
  const std::string_view before = std::string_view(text).substr(0, offset);
  const size_t line = before.rfind('\n');
  return {static_cast<uint32_t>(1 + std::count(before.begin(), before.end(), '\n')),
          static_cast<uint32_t>(offset - (line == std::string_view::npos ? 0 : line + 1) + 1)};
}

bool is_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// "$name" in quotes becomes the value, ${name} within a text its characters.
std::string substitute(PlantReader& reader, const std::string& text, const Case& one) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const bool quoted = text.compare(at, 2, "\"$") == 0 && at + 2 < text.size() && is_name(text[at + 2]);
    const bool braced = text.compare(at, 2, "${") == 0;
    if (!quoted && !braced) {
      out += text[at++];
      continue;
    }
    size_t end = at + 2;
    while (end < text.size() && is_name(text[end])) ++end;
    if (end == text.size() || text[end] != (quoted ? '"' : '}')) {
      out += text[at++];
      continue;
    }
    const std::string name = text.substr(at + 2, end - at - 2);
    const auto value = std::find_if(one.values.begin(), one.values.end(),
                                    [&](const CaseValue& candidate) { return candidate.name == name; });
    if (value == one.values.end())
      reader.error(place_at(text, at),
                   one.place.line == 0
                       ? fmt::format("'${}' is a value of a [[case]], and there is none", name)
                       : fmt::format("case '{}' has no value '{}'", one.name, name));
    else
      out += quoted ? value->toml : value->plain;
    at = end + 1;
  }
  return out;
}

void read_named_plant(PlantReader& reader, const toml::table& root, TestCase& test) {
  const std::string name = reader.text(root, "plant", "a test", true);
  if (name.empty()) return;
  const FilePlace place = place_of(*root.get("plant"));
  test.plant_expects = reader.flag(root, "plant_expects").value_or(false);
  for (const char* key : {"bus", "station", "control", "fault", "stimulus", "wire", "switch", "machine"})
    if (const toml::node* node = root.get(key))
      reader.error(place_of(*node), fmt::format("the plant is in {}: [[{}]] belongs there", name, key));
  test.plant_path = beside(test.file, name);
  const auto text = load_file(test.plant_path);
  if (!text) return reader.error(place, fmt::format("plant {}: {}", test.plant_path, text.error()));
  runtime::PlantFileResult plant = runtime::read_plant_file(*text, test.plant_path);
  if (!plant.errors.empty()) {
    test.errors = std::move(plant.errors);
    test.errors_in = test.plant_path;
    return;
  }
  if (test.plant_expects && plant.plant.expectations_of_tests != 0)
    reader.error(place_of(*root.get("plant_expects")),
                 fmt::format("{} has {} [[expect]] of kinds that only its own test looks at", test.plant_path,
                             plant.plant.expectations_of_tests));
  for (const runtime::StationConfig& station : plant.plant.stations)
    reader.station_names.insert(station.name);
  for (const runtime::ControlConfig& control : plant.plant.controls) {
    reader.station_names.insert(control.name);  // a fault may be of one
    if (control.as<runtime::GatewayConfig>() != nullptr) reader.gateway_names.insert(control.name);
  }
  reader.result.plant = std::move(plant.plant);
  if (!test.plant_expects) reader.result.plant.expectations.clear();
}

// Of the plant that the test names.
void add_plant_expectations(const runtime::PlantFile& plant, TestCase& test) {
  for (const runtime::Expectation& expectation : plant.expectations) {
    Expect expect;
    expect.subject.signal = expectation.signal;
    expect.condition.ranges.emplace_back(expectation.equals, expectation.equals);
    Item item;
    item.place = expectation.place;
    item.in_plant = true;
    item.at = expectation.at;
    item.what = std::move(expect);
    test.items.push_back(std::move(item));
  }
}

Item item_of(PlantReader& reader, const toml::table& table) {
  Item item;
  item.place = place_of(table);
  item.note = reader.lines(table, "note", "", false);
  std::replace(item.note.begin(), item.note.end(), '\n', ' ');
  if (const auto* at = table.get("at"); at != nullptr && at->value<std::string_view>() == "end")
    item.at_end = true;
  else if (at != nullptr)
    item.at = reader.duration(table, "at", "an item", true);
  if (table.contains("until")) {
    if (item.at) reader.error(place_of(*table.get("until")), "either at or until");
    item.at = reader.duration(table, "until", "an item", true);
  }
  for (const char* key : {"after", "wait"})
    if (const toml::node* node = table.get(key)) {
      if (item.at) reader.error(place_of(*node), fmt::format("either at or {}", key));
      item.after = reader.duration(table, key, "an item", true);
    }
  return item;
}

void read_items(PlantReader& reader, const toml::table& root, TestCase& test) {
  const size_t of_plant = test.items.size();  // these are looked at whatever the script does
  reader.for_each_table(root, "step", [&](const toml::table& table) {
    Item item = item_of(reader, table);
    if (auto step = read_step(reader, table)) {
      item.what = std::move(*step);
      test.items.push_back(std::move(item));
    }
  });
  reader.for_each_table(root, "expect", [&](const toml::table& table) {
    Item item = item_of(reader, table);
    if (auto expect = read_expect(reader, table)) {
      item.what = std::move(*expect);
      test.items.push_back(std::move(item));
    }
  });
  const auto first = test.items.begin() + static_cast<std::ptrdiff_t>(of_plant);
  std::stable_sort(first, test.items.end(), [](const Item& a, const Item& b) {
    return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
  });
  // Where every item has its time, the order of the file does not matter; steps act before anything is looked
  // at.
  if (std::all_of(first, test.items.end(), [](const Item& item) { return item.at.has_value(); }))
    std::stable_sort(first, test.items.end(), [](const Item& a, const Item& b) {
      return std::pair(*a.at, a.what.index()) < std::pair(*b.at, b.what.index());
    });
}

// Errors of planning that only matter to tests.
void check_test(PlantReader& reader) {
  for (runtime::BusConfig& bus : reader.result.plant.buses)
    if (runtime::has_outer_port(bus))
      reader.error(bus.port_place,
                   fmt::format("bus '{}' is joined to port '{}': a test runs in virtual time, "
                               "without the world outside",
                               bus.name, bus.port));
  // A test begins with an empty memory and leaves none behind.
  for (runtime::StationConfig& station : reader.result.plant.stations) station.nvram.clear();
}

void read_one(const std::string& text, TestCase& test) {
  PlantReader reader;
  const auto root = runtime::parse_toml(reader, text);
  if (root) {
    const bool named = root->contains("plant");
    if (named) {
      reader.known_keys(*root, "a test", runtime::kTestKeys);
      read_named_plant(reader, *root, test);
      if (!test.errors.empty()) return;
    } else {
      runtime::read_plant_sections(reader, *root, runtime::kTestKeys);
      if (const toml::node* node = root->get("plant_expects"))
        reader.error(place_of(*node), "plant_expects belongs to plant = \"...\"");
      test.plant_path = test.file;
    }
    test.speed = reader.count(*root, "speed", 1'000'000, 0);
    test.by_hand = reader.flag(*root, "by_hand").value_or(false);
    add_plant_expectations(reader.result.plant, test);
    if (!named || !reader.result.plant.stations.empty()) read_items(reader, *root, test);
    check_test(reader);
    if (!named || !reader.result.plant.stations.empty()) runtime::check_plant(reader);
  }
  test.errors = std::move(reader.result.errors);
  test.plant = std::move(reader.result.plant);
  test.plant.expectations.clear();  // they are items now
}

std::string test_name(const std::string& path) {
  std::string name = fs::path(path).lexically_normal().generic_string();
  for (const std::string_view ending : {".test.toml", ".toml"})
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size());
  return name;
}

}  // namespace

std::vector<TestCase> read_test_file(const std::string& path, const std::string& text) {
  TestCase base;
  base.name = test_name(path);
  base.file = path;
  base.place = {1, 1};
  base.lines = std::make_shared<const std::vector<std::string>>(text_lines(text));
  std::vector<TestCase> tests;
  PlantReader reader;
  const auto root = runtime::parse_toml(reader, text);
  std::vector<Case> cases;
  if (root && !runtime::refuse_others(reader, *root, path, {runtime::TomlKind::Plant, runtime::TomlKind::Test})) cases = read_cases(reader, *root);
  std::set<std::string> names;
  for (const Case& one : cases) reader.unique(names, one.name, "case", one.place);
  if (!reader.result.errors.empty()) {
    base.errors = std::move(reader.result.errors);
    tests.push_back(std::move(base));
    return tests;
  }
  const bool single = cases.empty();
  if (single) cases.push_back({});
  for (const Case& one : cases) {
    TestCase test = base;
    if (!single) {
      test.name += "/" + one.name;
      test.place = one.place;
    }
    PlantReader of_case;
    const std::string of_this = substitute(of_case, text, one);
    if (of_case.result.errors.empty())
      read_one(of_this, test);
    else
      test.errors = std::move(of_case.result.errors);
    tests.push_back(std::move(test));
  }
  return tests;
}

}  // namespace ipos::tools::testing
