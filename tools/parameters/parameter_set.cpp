// Reading a unit's settings, and their file in both directions.
#include "tools/parameters/parameter_set.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "runtime/plant_file/toml_sign.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

using runtime::FilePlace;
using runtime::place_of;
using stdlib::Parameter;
using stdlib::Service;

constexpr std::string_view kKey = runtime::kParameterSetKey;
constexpr int64_t kVersion = 1;

constexpr uint16_t kLock = 8595;  // P803

// Ordinary settings first, then those that may cut the connection (P810..P819, P88x, P89x), the lock last.
int load_rank(const Parameter& p) {
  if (p.index == kLock) return 2;
  return p.number.starts_with("81") || p.number.starts_with("88") || p.number.starts_with("89") ? 1 : 0;
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

class Reader {
 public:
  explicit Reader(const std::string& path) : path_(path) {}

  tl::expected<ParameterSet, std::vector<std::string>> read(std::string_view text) {
    if (const auto table = runtime::read_toml(text))
      file(*table);
    else
      error(table.error().place, table.error().text);
    if (!errors_.empty()) return tl::unexpected(std::move(errors_));
    return std::move(set_);
  }

 private:
  void error(FilePlace place, const std::string& text) {
    errors_.push_back(fmt::format("{}:{}:{}: error: {}", path_, place.line, place.column, text));
  }

  void file(const toml::table& root) {
    if (const auto why = runtime::wrong_kind(root, path_, {runtime::TomlKind::Parameters})) return error(why->place, why->text);
    for (const auto& [key, value] : root)
      if (key.str() != kKey && key.str() != "unit" && key.str() != "parameters")
        error({key.source().begin.line, key.source().begin.column},
              fmt::format("unknown key '{}'; known are {}, unit, parameters", key.str(), kKey));
    const toml::node* version = root.get(kKey);
    if (version == nullptr || version->value<int64_t>() != kVersion)
      return error(version ? place_of(*version) : FilePlace{1, 1},
                   fmt::format("no parameter set: it begins with {} = {}", kKey, kVersion));
    const toml::node* unit = root.get("unit");
    set_.unit = unit && unit->is_string() ? stdlib::find_unit(unit->as_string()->get()) : nullptr;
    if (set_.unit == nullptr)
      return error(unit ? place_of(*unit) : FilePlace{1, 1},
                   "unit must name a unit type: " + stdlib::unit_names());
    table_ = &stdlib::parameter_table(*set_.unit);
    const toml::node* parameters = root.get("parameters");
    if (parameters == nullptr || !parameters->is_array())
      return error(parameters ? place_of(*parameters) : FilePlace{1, 1}, "parameters must be a list");
    for (const toml::node& node : *parameters->as_array()) {
      if (const toml::table* entry = node.as_table())
        row(*entry);
      else
        error(place_of(node), "write { number = \"P130\", value = \"2.5 s\" }");
    }
  }

  void row(const toml::table& entry) {
    const FilePlace place = place_of(entry);
    for (const auto& [key, value] : entry) {
      const std::string_view name = key.str();
      const bool text = name == "number" || name == "name" || name == "value";
      if (!text && name != "index" && name != "raw")
        return error({key.source().begin.line, key.source().begin.column},
                     fmt::format("unknown key '{}'; known are number, index, name, value, raw", name));
      if (text ? !value.is_string() : !value.is_integer())
        return error(place_of(value),
                     fmt::format("{} must be a {}", name, text ? "text in quotes" : "whole number"));
    }
    const Parameter* parameter = find(entry, place);
    if (parameter == nullptr) return;
    const auto [first, added] = seen_.emplace(parameter->index, place);
    if (!added)
      return error(place,
                   fmt::format("index {} stands in line {} already", parameter->index, first->second.line));
    if (const auto value = value_of(entry, *parameter, place))
      set_.rows.push_back({parameter, *value, place});
  }

  // By index, else by number; both must mean the same.
  const Parameter* find(const toml::table& entry, FilePlace place) {
    const toml::node* index = entry.get("index");
    const toml::node* number = entry.get("number");
    const Parameter* parameter = nullptr;
    if (index != nullptr) {
      const int64_t wanted = index->as_integer()->get();
      if (wanted >= 0 && wanted <= 0xFFFF) parameter = table_->find(static_cast<uint16_t>(wanted));
      if (parameter == nullptr)
        error(place_of(*index),
              fmt::format("unit {} has no parameter with index {}", set_.unit->name, wanted));
    } else if (number != nullptr) {
      parameter = table_->find(number->as_string()->get());
      if (parameter != nullptr) parameter = table_->find(parameter->index);
      if (parameter == nullptr)
        error(place_of(*number), fmt::format("unit {} has no parameter {} with an index", set_.unit->name,
                                             number->as_string()->get()));
      return parameter;
    } else {
      error(place, "a parameter needs a number or an index");
    }
    if (parameter == nullptr || number == nullptr || number->as_string()->get().empty()) return parameter;
    const std::string& text = number->as_string()->get();
    for (const Parameter& named : table_->rows())
      if (named.index == parameter->index && "P" + std::string(named.number) == text) return parameter;
    error(place_of(*number),
          fmt::format("index {} is P{}, not {}", parameter->index, parameter->number, text));
    return nullptr;
  }

  // raw, or value; when both are there they must agree.
  std::optional<int32_t> value_of(const toml::table& entry, const Parameter& parameter, FilePlace place) {
    const toml::node* raw = entry.get("raw");
    const toml::node* text = entry.get("value");
    std::optional<int32_t> number;
    if (raw != nullptr) {
      const int64_t value = raw->as_integer()->get();
      if (value < INT32_MIN || value > UINT32_MAX)
        return error(place_of(*raw), "raw has at most 32 bits"), std::nullopt;
      number = static_cast<int32_t>(static_cast<uint32_t>(value));
    }
    if (text == nullptr) {
      if (!number) error(place, "a parameter needs a value or raw");
      return number;
    }
    const std::string& words = text->as_string()->get();
    if (number && stdlib::parameter_text(parameter, *number) == words) return number;
    const auto read = stdlib::parse_parameter_text(parameter, words);
    if (!read) return error(place_of(*text), fmt::format("\"{}\": {}", words, read.error())), std::nullopt;
    if (number && *number != *read) {
      error(place_of(*raw), fmt::format("raw = {} is {}, and value says {}: change both or leave one out",
                                        *number, stdlib::parameter_text(parameter, *number), words));
      return std::nullopt;
    }
    return *read;
  }

  const std::string& path_;
  std::vector<std::string> errors_;
  ParameterSet set_;
  const stdlib::ParameterTable* table_ = nullptr;
  std::map<uint16_t, FilePlace> seen_;
};

}  // namespace

std::string why(const stdlib::ParameterTable& table, Service service, uint16_t index, int32_t value,
                const AccessError& error) {
  if (error.code)
    return stdlib::explain_refusal(table, static_cast<uint8_t>(service), index, value, *error.code);
  return fmt::format("{}: {}", stdlib::index_name(table, index), error.trouble);
}

void print_refusal(const ParameterAccess& access, Service service, uint16_t index, int32_t value,
                   const AccessError& error, const std::string& place) {
  const std::string text = why(stdlib::parameter_table(access.unit()), service, index, value, error);
  if (!error.code) throw Failure(kIoError, fmt::format("{}: {}", access.name(), text));
  fmt::print(stderr, "{}refused: {}\n", place, text);
}

ParameterSet read_settings(ParameterAccess& access, bool& complete) {
  ParameterSet set;
  set.unit = &access.unit();
  const stdlib::ParameterTable& table = stdlib::parameter_table(*set.unit);
  for (const Parameter* parameter : table.by_index()) {
    if (!parameter->writable || !parameter->nonvolatile) continue;
    const AccessReply reply = access.execute(Service::Read, parameter->index);
    if (reply) {
      set.rows.push_back({parameter, *reply, {}});
      continue;
    }
    print_refusal(access, Service::Read, parameter->index, 0, reply.error(), "left out, ");
    complete = false;
  }
  return set;
}

std::vector<WrittenRow> write_settings(ParameterAccess& access, const ParameterSet& set, Service service) {
  std::vector<SetRow> rows = set.rows;
  std::stable_sort(rows.begin(), rows.end(), [](const SetRow& a, const SetRow& b) {
    return std::pair(load_rank(*a.parameter), a.parameter->index) <
           std::pair(load_rank(*b.parameter), b.parameter->index);
  });
  std::vector<WrittenRow> done;
  const auto write = [&](const SetRow& row, bool unlocks) {
    const uint16_t index = row.parameter->index;
    const AccessReply present = access.execute(Service::Read, index);
    if (present && *present == row.value) {
      done.push_back({row, WrittenRow::Outcome::Unchanged, unlocks, service, {}});
      return true;
    }
    const AccessReply reply = present ? access.execute(service, index, row.value) : present;
    if (reply)
      done.push_back({row, WrittenRow::Outcome::Written, unlocks, service, {}});
    else
      done.push_back(
          {row, WrittenRow::Outcome::Refused, unlocks, present ? service : Service::Read, reply.error()});
    return reply.has_value();
  };
  const Parameter* lock = stdlib::parameter_table(access.unit()).find(kLock);
  const AccessReply locked = lock != nullptr ? access.execute(Service::Read, kLock) : AccessReply(0);
  if (locked && *locked == 1 && write({lock, 0, {}}, true))
    if (rows.empty() || rows.back().parameter != lock) rows.push_back({lock, 1, {}});
  for (const SetRow& row : rows)
    if (!write(row, false) && !done.back().error.code) break;
  return done;
}

std::string to_text(const ParameterSet& set) {
  std::string text = fmt::format(
      "# The settings of a unit. value is for people, raw is what the unit has; change both, or one and "
      "delete the "
      "other.\n{} = {}\nunit = {}\nparameters = [\n",
      kKey, kVersion, in_quotes(set.unit->name));
  for (const SetRow& row : set.rows)
    text += fmt::format("  {{ number = {}, index = {}, name = {}, value = {}, raw = {} }},\n",
                        in_quotes("P" + std::string(row.parameter->number)), row.parameter->index,
                        in_quotes(row.parameter->name),
                        in_quotes(stdlib::parameter_text(*row.parameter, row.value)),
                        row.parameter->number_of(row.value));
  return text + "]\n";
}

bool is_parameter_set(std::string_view text) {
  while (!text.empty()) {
    if (text.starts_with(kKey)) return true;
    const size_t end = text.find('\n');
    if (end == std::string_view::npos) return false;
    text.remove_prefix(end + 1);
  }
  return false;
}

ParameterSet parse_settings(const std::string& path, std::string_view text) {
  auto set = read_parameter_set(path, text);
  if (set) return std::move(*set);
  for (const std::string& error : set.error()) fmt::print(stderr, "{}\n", error);
  throw Failure(kBadInput, "");
}

tl::expected<ParameterSet, std::vector<std::string>> read_parameter_set(const std::string& path,
                                                                        std::string_view text) {
  return Reader(path).read(text);
}

}  // namespace ipos::tools
