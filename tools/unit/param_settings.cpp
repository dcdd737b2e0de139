// save, load and diff: all settings of a unit at once.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/unit/param_actions.hpp"
#include "tools/unit/param_columns.hpp"

namespace ipos::tools {
namespace {

using stdlib::Parameter;
using stdlib::Service;
using Json = nlohmann::ordered_json;

constexpr uint16_t kLock = 8595;  // P803

// Ordinary settings first, then those that may cut the connection (P810..P819, P88x, P89x), the lock last.
int load_rank(const Parameter& p) {
  if (p.index == kLock) return 2;
  return p.number.starts_with("81") || p.number.starts_with("88") || p.number.starts_with("89") ? 1 : 0;
}

struct LoadCount {
  size_t written = 0;
  size_t unchanged = 0;
  size_t refused = 0;
  size_t overridden = 0;  // written, but the next start undoes it
};

// Writes what differs. Returns false when the unit refused it.
bool load_row(ParameterAccess& access, const SetRow& row, Service service, const std::string& file,
              LoadCount& count) {
  const uint16_t index = row.parameter->index;
  const AccessReply present = access.execute(Service::Read, index);
  if (present && *present == row.value) return ++count.unchanged, true;
  const AccessReply reply = present ? access.execute(service, index, row.value) : present;
  if (reply) {
    ++count.written;
    const std::string again = access.overridden_by(index);
    if (service == Service::Write && !again.empty()) {
      ++count.overridden;
      fmt::print(stderr, "{}\n", again);
    }
    return true;
  }
  ++count.refused;
  print_refusal(access, present ? service : Service::Read, index, row.value, reply.error(),
                row.place.line == 0 ? "" : fmt::format("{}:{}:{}: ", file, row.place.line, row.place.column));
  return false;
}

}  // namespace

int save_parameters(ParameterAccess& access, const std::string& file) {
  bool complete = true;
  const ParameterSet set = read_settings(access, complete);
  replace_file(file, to_text(set));
  if (!is_standard_output(file))
    fmt::print(stderr, "{} parameters of {} in {}\n", set.rows.size(), access.name(), file);
  return complete ? kGood : kFindings;
}

int load_parameters(ParameterAccess& access, const std::string& file, const ParameterSet& set,
                    bool is_volatile, bool as_json) {
  if (set.unit != &access.unit())
    throw Failure(kBadInput, fmt::format("{} is of unit {}, {} is {}", file, set.unit->name, access.name(),
                                         access.unit().name));
  std::vector<SetRow> rows = set.rows;
  std::stable_sort(rows.begin(), rows.end(), [](const SetRow& a, const SetRow& b) {
    return std::pair(load_rank(*a.parameter), a.parameter->index) <
           std::pair(load_rank(*b.parameter), b.parameter->index);
  });
  const Service service = is_volatile ? Service::WriteVolatile : Service::Write;
  LoadCount count;
  // A lock that is on comes off first, and is on again at the end unless the file says otherwise.
  const Parameter* lock = stdlib::parameter_table(access.unit()).find(kLock);
  const AccessReply locked = lock ? access.execute(Service::Read, kLock) : AccessReply(0);
  LoadCount of_lock;
  if (locked && *locked == 1 && load_row(access, {lock, 0, {}}, service, file, of_lock))
    if (rows.empty() || rows.back().parameter != lock) rows.push_back({lock, 1, {}});
  for (const SetRow& row : rows) load_row(access, row, service, file, count);

  int exit_code = count.refused == 0 && count.overridden == 0 ? kGood : kFindings;
  if (as_json) {
    const Json json{{"source", access.name()},
                    {"unit", access.unit().name},
                    {"written", count.written},
                    {"unchanged", count.unchanged},
                    {"refused", count.refused}};
    fmt::print("{}\n", json.dump(2));
  } else {
    fmt::print("{}: {} parameters: {} written, {} unchanged, {} refused\n", access.name(), rows.size(),
               count.written, count.unchanged, count.refused);
  }
  if (const std::string forgets = access.forgets(); !forgets.empty()) {
    fmt::print(stderr, "nothing is kept: {}\n", forgets);
    exit_code = is_volatile ? exit_code : kFindings;
  }
  return exit_code;
}

int diff_parameters(const ParameterSet& a, const std::string& a_name, const ParameterSet& b,
                    const std::string& b_name, bool as_json) {
  struct Pair {
    const SetRow* sides[2] = {nullptr, nullptr};
  };
  std::map<uint16_t, Pair> pairs;
  for (const SetRow& row : a.rows) pairs[row.parameter->index].sides[0] = &row;
  for (const SetRow& row : b.rows) pairs[row.parameter->index].sides[1] = &row;
  const auto text = [](const SetRow* row) {
    return row ? stdlib::parameter_text(*row->parameter, row->value) : std::string("-");
  };
  std::vector<std::vector<std::string>> lines{{"number", "index", "name", a_name, b_name}};
  Json json{{"a", a_name}, {"b", b_name}, {"differences", Json::array()}};
  for (const auto& [index, pair] : pairs) {
    const auto [left, right] = pair.sides;
    if (left && right && left->value == right->value) continue;
    const Parameter& parameter = *(left ? left : right)->parameter;
    const std::string number = "P" + std::string(parameter.number);
    lines.push_back({number, std::to_string(index), std::string(parameter.name), text(left), text(right)});
    Json row{{"number", number}, {"index", index}, {"name", parameter.name}};
    row["a"] = left ? Json(text(left)) : Json(nullptr);
    row["b"] = right ? Json(text(right)) : Json(nullptr);
    json["differences"].push_back(std::move(row));
  }
  const bool differ = lines.size() > 1;
  if (as_json)
    fmt::print("{}\n", json.dump(2));
  else if (differ)
    fmt::print("{}", columns(lines));
  return differ ? kFindings : kGood;
}

}  // namespace ipos::tools
