// The rows of unsimulated.def, spread over the parameters of each unit.
#include "stdlib/unsimulated.hpp"

#include <algorithm>
#include <charconv>
#include <string>

namespace ipos::stdlib {
namespace {

using UnitTest = bool (*)(const UnitType&);

// The codes of a value mean the same on units with the same list.
constexpr UnitTest All = nullptr;
bool OnMovidrive(const UnitType& unit) { return unit.lists.starts_with("md60a.tsv"); }
bool OnMovitrac(const UnitType& unit) { return unit.lists.starts_with("mc07.tsv"); }
bool OnMovitrac31(const UnitType& unit) { return unit.lists.starts_with("mc31.tsv"); }
bool OnMovidriveWithCards(const UnitType& unit) { return OnMovidrive(unit) && unit.has(Trait::OptionCards); }
bool OnMovidriveWithoutCards(const UnitType& unit) { return OnMovidrive(unit) && !unit.has(Trait::OptionCards); }
bool OnMovidriveWithoutFieldbus(const UnitType& unit) {
  return OnMovidrive(unit) && !unit.has(Trait::FieldbusCard);
}

bool is_about(UnitTest units, const UnitType& unit) { return units == All || units(unit); }

constexpr UnsimulatedRow kRows[] = {
#define UNSIMULATED(parameters, values, units, scope, text) \
  {parameters, values, units, UnsimulatedScope::scope, text},
#include "stdlib/unsimulated.def"
};

struct UnshownRow {
  std::string_view parameters;
  UnitTest units;
  std::string_view text;
};
constexpr UnshownRow kUnshown[] = {
#define UNSHOWN(parameters, units, text) {parameters, units, text},
#include "stdlib/unsimulated.def"
};

int64_t number_of(std::string_view text) {
  int64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

// "200..207,210"
std::vector<ValueRange> ranges_of(std::string_view text) {
  std::vector<ValueRange> ranges;
  while (!text.empty()) {
    const size_t comma = std::min(text.find(','), text.size());
    const std::string_view part = text.substr(0, comma);
    const size_t dots = part.find("..");
    const int64_t first = number_of(part.substr(0, dots));
    ranges.push_back({first, dots == std::string_view::npos ? first : number_of(part.substr(dots + 2)), 1});
    text.remove_prefix(std::min(comma + 1, text.size()));
  }
  return ranges;
}

bool holds(std::span<const ValueRange> ranges, int64_t number) {
  return std::any_of(ranges.begin(), ranges.end(), [&](const ValueRange& range) {
    return number >= range.minimum && number <= range.maximum;
  });
}

struct Numbered {
  int64_t number;
  const Parameter* parameter;
};

// The parameters that can be set, in rising order of their numbers.
std::vector<Numbered> settable(const ParameterTable& table) {
  std::vector<Numbered> all;
  for (const Parameter* parameter : table.by_index())
    if (parameter->writable && !parameter->number.empty())
      all.push_back({number_of(parameter->number), parameter});
  std::stable_sort(all.begin(), all.end(),
                   [](const Numbered& a, const Numbered& b) { return a.number < b.number; });
  return all;
}

std::vector<Unsimulated> make_list(const UnitType& unit) {
  std::vector<Unsimulated> list;
  const std::vector<Numbered> parameters = settable(parameter_table(unit));
  const auto below = [](const Numbered& one, int64_t wanted) { return one.number < wanted; };
  for (const UnsimulatedRow& row : kRows) {
    if (!is_about(row.units, unit)) continue;
    for (const ValueRange& numbers : ranges_of(row.parameters)) {
      auto at = std::lower_bound(parameters.begin(), parameters.end(), numbers.minimum, below);
      for (; at != parameters.end() && at->number <= numbers.maximum; ++at)
        list.push_back({at->parameter, &row, ranges_of(row.values)});
    }
  }
  std::stable_sort(list.begin(), list.end(), [](const Unsimulated& a, const Unsimulated& b) {
    return a.parameter->index < b.parameter->index;
  });
  return list;
}

}  // namespace

std::span<const UnsimulatedRow> unsimulated_rows() { return kRows; }

std::string UnsimulatedRow::unit_names() const {
  if (units == All) return "all";
  std::string names;
  for (const UnitType& unit : unit_types())
    if (units(unit)) names.append(names.empty() ? "" : ", ").append(unit.name);
  return names;
}

std::string_view unshown(const UnitType& unit, const Parameter& parameter) {
  if (parameter.writable || parameter.number.empty()) return {};
  for (const UnshownRow& row : kUnshown)
    if (is_about(row.units, unit) && holds(ranges_of(row.parameters), number_of(parameter.number)))
      return row.text;
  return {};
}

bool Unsimulated::applies(int32_t value) const {
  const int64_t number = parameter->number_of(value);
  return values.empty() ? number != parameter->default_value : holds(values, number);
}

std::string Unsimulated::text(int32_t value) const {
  return "P" + std::string(parameter->number) + " " + std::string(parameter->name) + " is " +
         parameter_text(*parameter, value) + ": " + std::string(row->text);
}

// Each list is made when the first who needs it asks.
std::span<const Unsimulated> unsimulated(const UnitType& unit) {
  switch (unit.code) {
#define UNIT(code, ...)                                           \
  case code: {                                                    \
    static const std::vector<Unsimulated> list = make_list(unit); \
    return list;                                                  \
  }
#include "stdlib/unit_types.def"
    default: return {};
  }
}

std::span<const Unsimulated> unsimulated(const UnitType& unit, uint16_t index) {
  const std::span<const Unsimulated> all = unsimulated(unit);
  const auto first =
      std::lower_bound(all.begin(), all.end(), index,
                       [](const Unsimulated& one, uint16_t wanted) { return one.parameter->index < wanted; });
  const auto last =
      std::find_if(first, all.end(), [&](const Unsimulated& one) { return one.parameter->index != index; });
  return {first, last};
}

}  // namespace ipos::stdlib
