// [[expect]] of a test file: what is looked at, which values are right, and when they have to be.
#include <algorithm>

#include "runtime/plant_file/expect_keys.hpp"
#include "tools/test_file/item_reader.hpp"

namespace ipos::tools::testing {
namespace {

using runtime::SignalKind;

constexpr std::string_view kExpect = "an [[expect]]";

std::optional<Subject> read_event(PlantReader& reader, const toml::table& table, const char* key) {
  const runtime::BusConfig* bus = read_item_bus(reader, table, kExpect);
  if (bus == nullptr) return std::nullopt;
  Subject subject;
  subject.kind = Subject::Kind::Message;
  subject.message = runtime::info(bus->kind).message;
  subject.bus = bus->name;
  subject.pattern = "*";
  if (key == nullptr) return subject;
  subject.pattern = reader.text(table, key, kExpect, true);
  if (key != subject.message) {
    reader.error(place_of(*table.get(key)),
                 fmt::format("bus '{}' carries {}s, no {}s", bus->name, subject.message, key));
    return std::nullopt;
  }
  return subject;
}

std::optional<Subject> read_subject(PlantReader& reader, const toml::table& table) {
  for (const char* key : {"frame", "telegram"})
    if (table.contains(key)) return read_event(reader, table, key);
  const bool of_line = table.contains("bus");
  if (of_line && !table.contains("signal")) return read_event(reader, table, nullptr);
  Subject subject;
  if (of_line) {
    const runtime::BusConfig* bus = read_item_bus(reader, table, kExpect);
    if (bus == nullptr) return std::nullopt;
    subject.signal.station = bus->name;
  } else {
    subject.signal.station = read_item_station(reader, table, kExpect, table.contains("signal"));
  }
  if (const toml::node* node = table.get("process_data")) {
    const auto word = read_word(reader, *node, true);
    if (!word) return std::nullopt;
    subject.kind = Subject::Kind::ProcessData;
    subject.signal.name = node->as_string()->get();
    return subject;
  }
  if (!reader.signal(table, kExpect, {"variable", "parameter", "input", "output", "state", "signal"},
                     subject.signal))
    return std::nullopt;
  if (subject.signal.kind == SignalKind::Any)
    subject.signal.decimals = table.contains("every")  // whose tolerance is a time
                                  ? PlantReader::expected_decimals(table, {"equals", "not", "min", "max", "one_of"})
                                  : PlantReader::expected_decimals(table, {"equals", "not", "min", "max", "one_of", "tolerance", "sequence"});
  return subject;
}

// In the form the subject has; false with an error.
bool read_value(PlantReader& reader, const toml::node& node, std::string_view key, const Subject& subject,
                int64_t& out) {
  if (node.is_boolean() && subject.signal.decimals == 0) {
    out = node.as_boolean()->get() ? 1 : 0;
    return true;
  }
  const bool process_data = subject.kind == Subject::Kind::ProcessData;
  if (!process_data && subject.signal.kind == SignalKind::Parameter) {
    int32_t value = 0;
    if (!reader.parameter_value(node, reader.unit_of(subject.signal.station), subject.signal.name, value)) return false;
    out = value;
    return true;
  }
  if (!reader.expected_number(node, key, subject.signal, out)) return false;
  if (process_data) out = static_cast<uint16_t>(out);
  return true;
}

template <typename Action>
void for_each_value(PlantReader& reader, const toml::table& table, const char* key, Action action) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return;
  const toml::array* list = node->as_array();
  if (list == nullptr || list->empty())
    return reader.error(place_of(*node), fmt::format("{} is a list, for example [1, 2]", key));
  for (const toml::node& entry : *list) action(entry);
}

bool read_condition(PlantReader& reader, const toml::table& table, const Subject& subject, Condition& out) {
  const auto value = [&](const char* key, int64_t& to) {
    const toml::node* node = table.get(key);
    return node != nullptr && read_value(reader, *node, key, subject, to);
  };
  int64_t first = 0;
  for (const char* key : {"equals", "not"}) {
    if (!value(key, first)) continue;
    out.ranges.emplace_back(first, first);
    out.negated = std::string_view(key) == "not";
  }
  const toml::node* tolerance = table.get("tolerance");
  if (tolerance != nullptr && !table.contains("every")) {
    int64_t width = 0;
    if (!table.contains("equals"))
      reader.error(place_of(*tolerance), "tolerance belongs to equals or every");
    else if (value("tolerance", width) && !out.ranges.empty())
      out.ranges.front() = {first - width, first + width};
  }
  if (table.contains("min") || table.contains("max")) {
    std::pair<int64_t, int64_t> range{INT64_MIN, INT64_MAX};
    value("min", range.first);
    value("max", range.second);
    if (range.first > range.second) reader.error(place_of(*table.get("max")), "max is below min");
    out.ranges.push_back(range);
  }
  for_each_value(reader, table, "one_of", [&](const toml::node& node) {
    if (read_value(reader, node, "one_of", subject, first)) out.ranges.emplace_back(first, first);
  });
  int forms = 0;
  for (const char* key : {"equals", "not", "one_of"}) forms += table.contains(key) ? 1 : 0;
  forms += table.contains("min") || table.contains("max") ? 1 : 0;
  if (forms > 1) {
    reader.error(place_of(table), "an [[expect]] has one of equals, not, one_of, or min and max");
    return false;
  }
  return forms == 1;
}

// The key that says of what kind it is; nullptr with an error when there are several.
struct KindKey {
  std::string_view key;
  Expect::Kind kind;
};
constexpr KindKey kKinds[] = {{"always", Expect::Kind::Always},    {"never", Expect::Kind::Never},
                              {"times", Expect::Kind::Count},      {"at_least", Expect::Kind::Count},
                              {"at_most", Expect::Kind::Count},    {"every", Expect::Kind::Every},
                              {"sequence", Expect::Kind::Sequence}};

bool read_kind(PlantReader& reader, const toml::table& table, Expect& expect) {
  const KindKey* found = nullptr;
  for (const KindKey& row : kKinds) {
    const toml::node* node = table.get(row.key);
    if (node == nullptr) continue;
    if (found != nullptr && found->kind == row.kind && row.key == "at_most" && found->key == "at_least")
      continue;
    if (found != nullptr) {
      reader.error(place_of(*node), fmt::format("{} has either {} or {}", kExpect, found->key, row.key));
      return false;
    }
    found = &row;
    if ((row.key == "always" || row.key == "never") && !reader.flag(table, row.key).value_or(false)) {
      reader.error(place_of(*node), fmt::format("write {} = true", row.key));
      return false;
    }
  }
  if (found != nullptr)
    expect.kind = found->kind;
  else if (table.contains("within"))
    expect.kind = Expect::Kind::Within;
  if (table.contains("times")) expect.least = expect.most = reader.count(table, "times", UINT32_MAX, 0);
  if (table.contains("at_least")) expect.least = reader.count(table, "at_least", UINT32_MAX, 0);
  if (table.contains("at_most")) expect.most = reader.count(table, "at_most", UINT32_MAX, 0);
  return true;
}

void read_times(PlantReader& reader, const toml::table& table, Expect& expect) {
  const auto time = [&](const char* key, std::optional<Time>& to) {
    if (table.contains(key)) to = reader.duration(table, key, kExpect, true);
  };
  time("within", expect.within);
  time("during", expect.during);
  if (expect.within && expect.during)
    reader.error(place_of(*table.get("during")), "either within, and the test waits, or during");
  const bool waits = expect.kind == Expect::Kind::Within || expect.kind == Expect::Kind::Sequence ||
                     (expect.kind == Expect::Kind::Count && expect.most == UINT64_MAX);
  if (expect.within && !waits)
    reader.error(place_of(*table.get("within")),
                 "within belongs to a value, a frame, at_least or a sequence; write during = \"...\"");
  if (expect.during && expect.kind == Expect::Kind::Now)
    reader.error(place_of(*table.get("during")),
                 "during belongs to always, never, times, at_least, at_most, every or sequence");
  if (expect.kind == Expect::Kind::Every) {
    expect.period = reader.duration(table, "every", kExpect, true);
    if (table.contains("tolerance")) expect.tolerance = reader.duration(table, "tolerance", kExpect, true);
    if (expect.period < runtime::kShortest)
      reader.error(place_of(*table.get("every")), "every is less than a millisecond");
  }
}

void read_sequence(PlantReader& reader, const toml::table& table, Expect& expect) {
  if (table.contains("repeat") && expect.kind != Expect::Kind::Sequence)
    reader.error(place_of(*table.get("repeat")), "repeat belongs to a sequence");
  expect.repeat = reader.flag(table, "repeat").value_or(false);
  for_each_value(reader, table, "sequence", [&](const toml::node& node) {
    int64_t value = 0;
    if (!expect.subject.is_event()) {
      if (read_value(reader, node, "sequence", expect.subject, value)) expect.values.push_back(value);
    } else if (const auto* pattern = node.as_string()) {
      expect.patterns.push_back(pattern->get());
    } else {
      reader.error(place_of(node), "a sequence of frames is a list of texts");
    }
  });
}

}  // namespace

std::optional<Expect> read_expect(PlantReader& reader, const toml::table& table) {
  std::vector<std::string_view> known = runtime::kExpectKeys;
  known.insert(known.end(), runtime::kTestExpectKeys.begin(), runtime::kTestExpectKeys.end());
  reader.known_keys(table, "[[expect]]", known);
  const auto subject = read_subject(reader, table);
  if (!subject) return std::nullopt;
  Expect expect;
  expect.subject = *subject;
  if (!read_kind(reader, table, expect)) return std::nullopt;
  read_times(reader, table, expect);
  read_sequence(reader, table, expect);
  const size_t errors = reader.result.errors.size();
  const bool has_condition = read_condition(reader, table, *subject, expect.condition);
  if (reader.result.errors.size() != errors) return std::nullopt;
  const bool sequence = expect.kind == Expect::Kind::Sequence;
  if (subject->is_event() || sequence) {
    if (has_condition)
      reader.error(place_of(table), fmt::format("{} takes no equals, not, min, max or one_of",
                                                sequence ? "a sequence" : "a frame or telegram"));
    if (expect.kind == Expect::Kind::Now)
      reader.error(
          place_of(table),
          "a frame or telegram needs within, never, always, times, at_least, at_most, every or sequence");
  } else if (!has_condition) {
    reader.error(place_of(table), "an [[expect]] needs equals = ..., not, one_of, min or max");
  }
  return expect;
}

std::optional<Expect> read_await(PlantReader& reader, const toml::table& table) {
  Expect expect;
  const runtime::BusConfig* bus = read_item_bus(reader, table, "an await");
  expect.subject.pattern = reader.text(table, "await", "an await", true);
  expect.kind = Expect::Kind::Within;
  expect.within = reader.duration(table, "within", "an await", true);
  if (bus == nullptr) return std::nullopt;
  expect.subject.kind = Subject::Kind::Message;
  expect.subject.message = runtime::info(bus->kind).message;
  expect.subject.bus = bus->name;
  return expect;
}

}  // namespace ipos::tools::testing
