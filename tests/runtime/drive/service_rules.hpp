// What a parameter service has to answer, computed from the cells of the lists: for the drive's classes (services_sweep_test.cpp) and
// for a unit of a plant that is asked over its buses (tests/runtime/manuals/services_test.cpp).
#pragma once

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
