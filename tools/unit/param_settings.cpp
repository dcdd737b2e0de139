// save, load and diff: all settings of a unit at once.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/cli/failure.hpp"
#include "tools/cli/json_text.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/parameters/param_columns.hpp"
#include "tools/unit/param_actions.hpp"

namespace ipos::tools {
namespace {

using stdlib::Parameter;
using stdlib::Service;
using Json = nlohmann::ordered_json;

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
  const Service service = is_volatile ? Service::WriteVolatile : Service::Write;
  size_t rows = 0, written = 0, unchanged = 0, refused = 0, overridden = 0;
  for (const WrittenRow& row : write_settings(access, set, service)) {
    const SetRow& of = row.row;
    const size_t one = row.unlocks ? 0 : 1;
    rows += one;
    if (row.outcome == WrittenRow::Outcome::Refused) {
      refused += one;
      print_refusal(
          access, row.service, of.parameter->index, of.value, row.error,
          of.place.line == 0 ? "" : fmt::format("{}:{}:{}: ", file, of.place.line, of.place.column));
    } else if (row.outcome == WrittenRow::Outcome::Unchanged) {
      unchanged += one;
    } else {
      written += one;
      const std::string again = service == Service::Write ? access.overridden_by(of.parameter->index) : "";
      if (again.empty()) continue;
      overridden += one;
      fmt::print(stderr, "{}\n", again);
    }
  }

  int exit_code = refused == 0 && overridden == 0 ? kGood : kFindings;
  if (as_json) {
    const Json json{{"source", access.name()},
                    {"unit", access.unit().name},
                    {"written", written},
                    {"unchanged", unchanged},
                    {"refused", refused}};
    fmt::print("{}\n", json_text(json, 2));
  } else {
    fmt::print("{}: {} parameters: {} written, {} unchanged, {} refused\n", access.name(), rows, written,
               unchanged, refused);
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
    fmt::print("{}\n", json_text(json, 2));
  else if (differ)
    fmt::print("{}", columns(lines));
  return differ ? kFindings : kGood;
}

}  // namespace ipos::tools
