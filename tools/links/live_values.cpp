// Names to indices, values to rows.
#include "tools/links/live_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "runtime/signals/variables.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/json_text.hpp"
#include "tools/input/program.hpp"
#include "tools/parameters/param_columns.hpp"
#include "tools/parameters/parameter_set.hpp"

namespace ipos::tools {
namespace {

using stdlib::Service;
using Json = nlohmann::ordered_json;

constexpr std::string_view kHex = ":hex";

// What the name stands for in the program or the unit; false when there is none.
bool add_variables(std::span<const vm::Symbol> symbols, const stdlib::UnitType& unit, const std::string& name,
                   bool hex, std::vector<LiveItem>& items) {
  const auto found = signals::named_variables(symbols, unit, name);
  for (const signals::NamedVariable& row : found)
    items.push_back({row.name, {static_cast<uint16_t>(stdlib::kFirstVariables + row.number), nullptr}, hex});
  return !found.empty();
}

std::string shown(const LiveItem& item, int32_t value) {
  return item.hex ? fmt::format("{:08X} h", static_cast<uint32_t>(value)) : text_of(item.target, value);
}

}  // namespace

std::vector<LiveItem> live_items(const stdlib::UnitType& unit, const std::vector<std::string>& names,
                                 const vm::Image* image, const CompileFlags& compile) {
  std::vector<LiveItem> items;
  std::map<std::string, vm::Image> programs;
  for (const std::string& text : names) {
    const bool hex = text.ends_with(kHex);
    const std::string name = hex ? text.substr(0, text.size() - kHex.size()) : text;
    const size_t at = name.find('@');
    if (at != std::string::npos) {
      const std::string file = name.substr(at + 1);
      CompileFlags flags = compile;
      flags.unit = unit.name;
      auto known = programs.find(file);
      if (known == programs.end()) known = programs.emplace(file, load_program(file, flags)).first;
      if (!add_variables(known->second.symbols, unit, name.substr(0, at), hex, items))
        throw Failure(kBadInput, fmt::format("{} has no variable '{}'", file, name.substr(0, at)));
      continue;
    }
    const auto symbols =
        image != nullptr ? std::span<const vm::Symbol>(image->symbols) : std::span<const vm::Symbol>();
    if (add_variables(symbols, unit, name, hex, items)) continue;
    const Target target = find_target(unit, name);
    items.push_back({name_of(stdlib::parameter_table(unit), target), target, hex});
  }
  return items;
}

LiveTable::LiveTable(std::vector<LiveItem> items, LiveForm form)
    : items_(std::move(items)), form_(form), has_reason_(items_.size()) {}

void LiveTable::print(double seconds, ParameterAccess& access) {
  const stdlib::ParameterTable& table = stdlib::parameter_table(access.unit());
  std::vector<std::string> texts;
  Json json{{"time", seconds}, {"values", Json::array()}};
  for (const LiveItem& item : items_) {
    const AccessReply reply = access.execute(Service::Read, item.target.index);
    texts.push_back(reply ? shown(item, *reply) : "-");
    Json value{{"name", item.name}, {"index", item.target.index}};
    value["value"] = reply ? Json(*reply) : Json(nullptr);
    value["text"] = texts.back();
    json["values"].push_back(std::move(value));
    if (reply) continue;
    complete_ = false;
    const size_t n = texts.size() - 1;
    if (has_reason_[n]) continue;
    has_reason_[n] = true;
    const std::string reason = why(table, Service::Read, item.target.index, 0, reply.error());
    if (std::find(told_.begin(), told_.end(), reason) != told_.end()) continue;
    told_.push_back(reason);
    fmt::print(stderr, "ipos: {}: {}\n", access.name(), reason);
  }
  if (form_ == LiveForm::Json) {
    fmt::print("{}\n", json_text(json));
  } else if (form_ == LiveForm::Once) {
    std::vector<std::vector<std::string>> lines;
    for (size_t n = 0; n < items_.size(); ++n) {
      const std::string plain = stdlib::index_name(table, items_[n].target.index);  // "H420"
      const bool symbol = items_[n].target.parameter == nullptr && plain != items_[n].name;
      lines.push_back({symbol ? plain + " " + items_[n].name : items_[n].name, texts[n]});
    }
    fmt::print("{}", columns(lines));
  } else {
    print_rows(seconds, texts);
  }
  std::fflush(stdout);
}

// The widths are those of the first row, with some room: later values may be longer.
void LiveTable::print_rows(double seconds, const std::vector<std::string>& texts) {
  if (widths_.empty()) {
    constexpr size_t kRoom = 12;
    std::string head = fmt::format("{:>9}", "s");
    for (size_t n = 0; n < items_.size(); ++n) {
      widths_.push_back(std::max({items_[n].name.size(), texts[n].size(), kRoom}));
      head += fmt::format("  {:>{}}", items_[n].name, widths_[n]);
    }
    fmt::print("{}\n", head);
  }
  std::string row = fmt::format("{:9.3f}", seconds);
  for (size_t n = 0; n < texts.size(); ++n) row += fmt::format("  {:>{}}", texts[n], widths_[n]);
  fmt::print("{}\n", row);
}

}  // namespace ipos::tools
