// Rows, groups, values and their texts.
#include "tools/serve/host/parameter_rows.hpp"

#include <fmt/format.h>

#include <set>

#include "stdlib/parameters.hpp"
#include "tools/parameters/parameter_set.hpp"

namespace ipos::tools::serve {
namespace {

using stdlib::Parameter;
using stdlib::ParameterTable;
using stdlib::Service;

struct ParameterGroup {
  std::string_view digits;
  std::string_view name;
};
constexpr ParameterGroup kGroups[] = {
#define PARAMETER_GROUP(digits, name) {digits, name},
#include "tools/serve/host/parameter_groups.def"
};

std::string group_of(const Parameter& parameter) {
  return parameter.number.size() < 2 ? "" : "P" + std::string(parameter.number.substr(0, 2));
}

bool is_setting(const Parameter& parameter) { return parameter.writable && !parameter.view; }

Json limit(ParameterAccess& access, Service service, const Parameter& parameter) {
  if (parameter.ranges.empty() && parameter.texts.empty()) return nullptr;
  const AccessReply reply = access.execute(service, parameter.index, 0);
  return reply ? Json(stdlib::parameter_text(parameter, *reply)) : Json(nullptr);
}

}  // namespace

std::string number_of(const Parameter& parameter) {
  return parameter.number.empty() ? "" : "P" + std::string(parameter.number);
}

int32_t factory_setting(const Parameter& parameter) {
  return static_cast<int32_t>(static_cast<uint32_t>(parameter.default_value));
}

Json value_json(const Parameter& parameter, int32_t value) {
  return {{"value", parameter.number_of(value)},
          {"text", stdlib::parameter_text(parameter, value)},
          {"changed", is_setting(parameter) && value != factory_setting(parameter)}};
}

Json parameter_list(ParameterAccess& access) {
  const ParameterTable& table = stdlib::parameter_table(access.unit());
  Json parameters = Json::array();
  std::set<std::string> used;
  for (const Parameter& p : table.rows()) {
    if (p.index == 0) continue;
    const std::string group = group_of(p);
    if (!group.empty()) used.insert({group, group.substr(0, 2)});
    Json choices = Json::array();
    for (const stdlib::ValueText& text : p.texts) choices.push_back(text.text);
    const AccessReply value = access.execute(Service::Read, p.index, 0);
    Json row = value ? value_json(p, *value) : Json{{"value", nullptr}, {"text", ""}, {"changed", false}};
    row["number"] = number_of(p);
    row["index"] = p.index;
    row["name"] = p.name;
    row["group"] = group;
    row["unit"] = p.display;
    row["access"] = access_text(p);
    row["default"] = is_setting(p) ? Json(stdlib::parameter_text(p, factory_setting(p))) : Json(nullptr);
    row["least"] = p.writable ? limit(access, Service::ReadMinimum, p) : Json(nullptr);
    row["most"] = p.writable ? limit(access, Service::ReadMaximum, p) : Json(nullptr);
    row["choices"] = std::move(choices);
    // Another row leads what it shows.
    const Parameter* const leads = p.view ? table.find(p.index) : nullptr;
    row["shows"] = leads == nullptr ? Json(nullptr) : Json(leads->number.empty() ? std::to_string(p.index) : number_of(*leads));
    parameters.push_back(std::move(row));
  }
  Json groups = Json::array();
  for (const ParameterGroup& group : kGroups)
    if (used.count("P" + std::string(group.digits)) != 0)
      groups.push_back({{"number", "P" + std::string(group.digits)}, {"name", group.name}});
  return {{"groups", std::move(groups)}, {"parameters", std::move(parameters)}};
}

Json load_settings(ParameterAccess& access, const std::string& text) {
  const auto set = read_parameter_set("the file", text);
  if (!set) throw Mistake(fmt::format("{}", fmt::join(set.error(), "\n")));
  if (set->unit != &access.unit())
    throw Mistake(
        fmt::format("the file is of unit {}, {} is {}", set->unit->name, access.name(), access.unit().name));
  const ParameterTable& table = stdlib::parameter_table(access.unit());
  size_t written = 0, unchanged = 0;
  Json refused = Json::array();
  for (const WrittenRow& row : write_settings(access, *set, Service::Write)) {
    if (row.unlocks) continue;
    if (row.outcome == WrittenRow::Outcome::Written) ++written;
    if (row.outcome == WrittenRow::Outcome::Unchanged) ++unchanged;
    if (row.outcome == WrittenRow::Outcome::Refused)
      refused.push_back(
          {{"number", number_of(*row.row.parameter)},
           {"text", why(table, row.service, row.row.parameter->index, row.row.value, row.error)}});
  }
  return {{"set", written}, {"unchanged", unchanged}, {"refused", std::move(refused)}};
}

int32_t value_of(const Target& target, const std::string& text) {
  if (target.parameter != nullptr) {
    const auto value = stdlib::parse_parameter_text(*target.parameter, text);
    if (!value) throw Mistake(value.error());
    return *value;
  }
  const auto number = whole_number<int32_t>(text);
  if (!number) throw Mistake("expected a whole number");
  return *number;
}

void write_parameter(ParameterAccess& access, uint16_t index, int32_t value, bool is_volatile) {
  const Service service = is_volatile ? Service::WriteVolatile : Service::Write;
  const AccessReply reply = access.execute(service, index, value);
  if (reply) return;
  const std::string text = why(stdlib::parameter_table(access.unit()), service, index, value, reply.error());
  if (reply.error().code) throw Refusal(text);
  throw Mistake(text);
}

}  // namespace ipos::tools::serve
