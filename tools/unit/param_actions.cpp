// list, get and set. Values go to stdout, refusals to stderr.
#include "tools/unit/param_actions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/cli/failure.hpp"
#include "tools/cli/json_text.hpp"
#include "tools/parameters/param_columns.hpp"
#include "tools/parameters/parameter_target.hpp"

namespace ipos::tools {
namespace {

using stdlib::Parameter;
using stdlib::ParameterTable;
using stdlib::Service;
using Json = nlohmann::ordered_json;

std::string number_of(const Parameter& parameter) {
  return parameter.number.empty() ? "" : "P" + std::string(parameter.number);
}

Json json_of(const ParameterTable& table, const Target& target, int32_t value) {
  Json row;
  row["number"] = target.parameter ? number_of(*target.parameter) : "";
  row["index"] = target.index;
  row["name"] =
      target.parameter ? std::string(target.parameter->name) : stdlib::index_name(table, target.index);
  row["value"] = target.parameter ? target.parameter->number_of(value) : int64_t{value};
  row["text"] = text_of(target, value);
  return row;
}

Json json_head(const ParameterAccess& access) {
  return {{"source", access.name()}, {"unit", access.unit().name}, {"parameters", Json::array()}};
}

// A limit or the default, from the unit; from its list where the unit has no such service (MOVITRAC 07).
int32_t limit(ParameterAccess& access, Service service, const Parameter& parameter, int64_t listed) {
  const AccessReply reply = access.execute(service, parameter.index);
  if (reply) return *reply;
  if (!reply.error().code) print_refusal(access, service, parameter.index, 0, reply.error());
  return static_cast<int32_t>(static_cast<uint32_t>(listed));
}

}  // namespace

int list_parameters(ParameterAccess& access, const ListChoice& choice) {
  const ParameterTable& table = stdlib::parameter_table(access.unit());
  std::string prefix = choice.group;
  if (prefix.starts_with('P') || prefix.starts_with('p')) prefix.erase(0, 1);
  std::vector<std::vector<std::string>> lines;
  if (choice.detailed)
    lines.push_back({"number", "index", "access", "name", "value", "default", "minimum", "maximum"});
  Json json = json_head(access);
  std::map<uint16_t, AccessReply> values;  // views show an index that was read before
  int exit_code = kGood;
  for (const Parameter& p : table.rows()) {
    if (p.index == 0 || !p.number.starts_with(prefix)) continue;
    if (choice.changed && (p.view || !p.writable)) continue;
    const Target target{p.index, &p};
    const bool known = values.count(p.index) > 0;
    const AccessReply reply =
        values.try_emplace(p.index, known ? AccessReply(0) : access.execute(Service::Read, p.index))
            .first->second;
    if (!reply) {
      print_refusal(access, Service::Read, p.index, 0, reply.error());
      exit_code = kFindings;
      continue;
    }
    const bool needs_default = choice.changed || choice.detailed;
    const int32_t normal = needs_default ? limit(access, Service::ReadDefault, p, p.default_value) : 0;
    if (choice.changed && *reply == normal) continue;
    std::vector<std::string> line{number_of(p), std::to_string(p.index)};
    if (choice.detailed) line.push_back(access_text(p));
    line.insert(line.end(), {std::string(p.name), text_of(target, *reply)});
    if (needs_default && !choice.detailed)
      line.push_back("(factory setting " + text_of(target, normal) + ")");
    Json row = json_of(table, target, *reply);
    if (needs_default) row["default"] = p.number_of(normal);
    if (choice.detailed) {
      const int32_t minimum = limit(access, Service::ReadMinimum, p, p.minimum());
      const int32_t maximum = limit(access, Service::ReadMaximum, p, p.maximum());
      const bool free = p.ranges.empty() && p.texts.empty();
      line.insert(line.end(), {text_of(target, normal), free ? "" : text_of(target, minimum),
                               free ? "" : text_of(target, maximum)});
      row["minimum"] = p.number_of(minimum);
      row["maximum"] = p.number_of(maximum);
      row["access"] = access_text(p);
    }
    lines.push_back(std::move(line));
    json["parameters"].push_back(std::move(row));
  }
  fmt::print("{}", choice.json ? json_text(json, 2) + "\n" : columns(lines));
  return exit_code;
}

int get_parameters(ParameterAccess& access, const std::vector<std::string>& names, bool as_json) {
  const ParameterTable& table = stdlib::parameter_table(access.unit());
  std::vector<Target> targets;
  for (const std::string& name : names) targets.push_back(find_target(access.unit(), name));
  Json json = json_head(access);
  int exit_code = kGood;
  for (const Target& target : targets) {
    const AccessReply reply = access.execute(Service::Read, target.index);
    if (!reply) {
      print_refusal(access, Service::Read, target.index, 0, reply.error());
      exit_code = kFindings;
      continue;
    }
    if (as_json)
      json["parameters"].push_back(json_of(table, target, *reply));
    else
      fmt::print("{} = {}\n", name_of(table, target), text_of(target, *reply));
  }
  if (as_json) fmt::print("{}\n", json_text(json, 2));
  return exit_code;
}

int set_parameters(ParameterAccess& access, const std::vector<std::string>& assignments, bool is_volatile,
                   bool as_json) {
  struct Assignment {
    Target target;
    int32_t value;
  };
  const ParameterTable& table = stdlib::parameter_table(access.unit());
  std::vector<Assignment> wanted;
  bool good = true;
  for (const std::string& text : assignments) {
    const size_t sign = text.find('=');
    if (sign == std::string::npos) throw Failure(kUsage, fmt::format("'{}': write P130=2.5s", text));
    const Target target = find_target(access.unit(), text.substr(0, sign));
    const std::string words = text.substr(sign + 1);
    tl::expected<int32_t, std::string> value = 0;
    if (target.parameter)
      value = stdlib::parse_parameter_text(*target.parameter, words);
    else if (const auto number = whole_number<int32_t>(words))
      value = *number;
    else
      value = tl::unexpected(std::string("expected a whole number"));
    if (value) {
      wanted.push_back({target, *value});
      continue;
    }
    fmt::print(stderr, "ipos: error: {} = \"{}\": {}\n", name_of(table, target), words, value.error());
    good = false;
  }
  if (!good) return kBadInput;

  Json json = json_head(access);
  int exit_code = kGood;
  const Service service = is_volatile ? Service::WriteVolatile : Service::Write;
  for (const auto& [target, value] : wanted) {
    const AccessReply before = access.execute(Service::Read, target.index);
    const AccessReply reply = access.execute(service, target.index, value);
    if (!reply) {
      print_refusal(access, service, target.index, value, reply.error());
      exit_code = kFindings;
      continue;
    }
    if (as_json) {
      Json row = json_of(table, target, value);
      if (before) row["before"] = text_of(target, *before);
      json["parameters"].push_back(std::move(row));
    } else {
      fmt::print("{} = {}{}\n", name_of(table, target), text_of(target, value),
                 before ? fmt::format(" (was {})", text_of(target, *before)) : "");
    }
    const std::string again = before && *before != value ? access.overridden_by(target.index) : "";
    if (!again.empty() && !is_volatile) {
      fmt::print(stderr, "{}\n", again);
      exit_code = kFindings;
    }
  }
  if (as_json) fmt::print("{}\n", json_text(json, 2));
  if (const std::string forgets = access.forgets(); !forgets.empty()) {
    fmt::print(stderr, "nothing is kept: {}\n", forgets);
    exit_code = is_volatile ? exit_code : kFindings;
  }
  return exit_code;
}

}  // namespace ipos::tools
