// What a parameter service has to answer, computed from the cells of the lists: for the drive's classes (services_sweep_test.cpp) and
// for a unit of a plant that is asked over its buses (tests/runtime/manuals/services_test.cpp).
#pragma once

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "tests/stdlib/parameter_list.hpp"

namespace ipos::tests {

struct UnitLists {
  const char* unit;
  std::vector<std::string> files;
  bool option_cards;
};
inline const UnitLists kUnits[] = {{"md60a", {"md60a.tsv"}, true},
                                   {"compact", {"md60a.tsv"}, false},
                                   {"mdxb", {"md60a.tsv", "mdxb.tsv"}, true},
                                   {"mc07", {"mc07.tsv"}, true}};

// Rows of MOVIDRIVE as they are printed.
struct PrintedRow {
  uint16_t index;
  int32_t default_value, minimum, maximum;
};
inline constexpr PrintedRow kPrintedRows[] = {
    {8597, 0, 0, 99},         {8598, 100, 100, 199},  {8599, 0, 0, 650000}, {8600, 0, 0, 63},
    {8601, 0, 0, 63},         {8602, 100, 0, 650000}, {8603, 2, 0, 3},      {8604, 0, 0, 2047000},
    {8732, 1000, 0, 2047000}, {8606, 500, 0, 650000}, {8609, 3, 0, 7},      {8610, 4, 0, 7},
    {8611, 3, 0, 7},          {8612, 7, 0, 7},        {8613, 3, 0, 7},      {8616, 0, 0, 7},
    {8615, 3, 0, 7},          {8304, 9, 0, 12},       {8305, 1, 0, 12},     {8306, 0, 0, 12},
    {8307, 6, 0, 11},         {8308, 1, 0, 11},       {8309, 2, 0, 11},     {8461, 0, 0, 10},
    {8462, 0, 0, 3}};

// Where indices are. In a window each has a value: variables, program and curve points. In an area of parameters those of the list have
// one, the others are refused with 11h, as are the tables of errors and of the motor.
struct Area {
  int first, count;
  bool contains(int index) const { return index >= first && index < first + count; }
};
struct IndexAreas {
  std::vector<Area> windows;
  std::vector<Area> parameters;

  static bool any(const std::vector<Area>& all, int index) {
    return std::any_of(all.begin(), all.end(), [index](const Area& area) { return area.contains(index); });
  }
};
inline IndexAreas index_areas(const UnitLists& unit) {
  const std::string name = unit.unit;
  IndexAreas out{{{11'000, name == "mdxb" ? 1024 : 512}}, {}};
  if (name == "mc07") {
    out.windows.push_back({16'000, 1024});
  } else {
    out.windows.insert(out.windows.end(), {{16'000, 2048}, {20'000, 513}});
    out.parameters = {{8300, 700}, {10'000, 100}, {10'300, 40}, {10'600, 40}};
  }
  return out;
}

inline constexpr uint32_t kOk = 0;
constexpr uint32_t refusal(uint32_t additional) { return 0x0800'0000U | additional; }
inline constexpr uint32_t kWrongManagement = 0x0505'0000U;

struct Expected {
  uint32_t code = kOk;
  int64_t value = 0;
};

inline std::set<int64_t> probes(const ListedParameter& p) {
  const int64_t first_step = p.ranges.empty() ? 1 : p.ranges.front()[2];
  const int64_t last_step = p.ranges.empty() ? 1 : p.ranges.back()[2];
  std::set<int64_t> values = {p.minimum(), p.minimum() - first_step, p.maximum(), p.maximum() + last_step,
                              p.default_value};
  for (const auto& [low, high, step] : p.ranges) {
    if (step > 1) values.insert(low + 1);
    if (step > 1) values.insert(high - 1);
    if (&p.ranges.back()[1] != &high) values.insert(high + 1);  // in the gap, or off the next grid
  }
  for (const auto& [code, logodrive] : p.codes) values.insert(code + 1);
  std::erase_if(values, [&](int64_t value) { return !p.sendable(value); });
  return values;
}

inline Expected expected_of(const ListedParameter& p, bool m07, int service, int64_t value) {
  if (service > 8 || (m07 && (service == 4 || service == 5 || service == 7))) return {kWrongManagement};
  switch (service) {
    case 0: return {kOk, 0};
    case 1:
    case 6: return {kOk, p.default_value};
    case 4: return {kOk, p.minimum()};
    case 5: return {kOk, p.maximum()};
    case 7: {
      const std::string& quantity = p.cells.at("quantity");
      const int conversion = std::stoi(p.cells.at("conversion"));
      return {kOk, (quantity.empty() ? 255 : std::stoi(quantity)) * 256 +
                       (conversion < 0 ? conversion + 256 : conversion)};
    }
    default: break;
  }
  if (!p.has("RW")) return {refusal(0x12)};
  if (value < p.minimum()) return {refusal(0x16)};
  if (value > p.maximum()) return {refusal(0x15)};
  if (!p.legal(value)) return {refusal(0x1D)};
  return {kOk, value};
}

inline int32_t bits(int64_t number) { return static_cast<int32_t>(static_cast<uint32_t>(number)); }

}  // namespace ipos::tests
