// Parameters, numbered variables and bits are too many for a list: it says how they are called.
#include "tools/run/signal_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/find.hpp"
#include "tools/cli/json_text.hpp"

namespace ipos::tools {
namespace {

constexpr std::string_view kMore =
    "\nAlso: STATION.P130 (any parameter), STATION.H500 (any variable), STATION.PO1.6 (a bit of a word or "
    "variable),\nBUS.frames (frames or telegrams), patterns with * and ? (STATION.D*).\n";

}  // namespace

std::string signal_list(const runtime::Plant& plant, bool json) {
  const auto signals = signals::plant_signals(plant);
  if (json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const signals::Signal& signal : signals)
      list.push_back({{"name", signal.name},
                      {"group", signals::group_text(signal.group)},
                      {"unit", signal.unit},
                      {"bits", signal.bits},
                      {"meaning", signal.meaning}});
    return json_text(list) + "\n";
  }
  size_t name = 0, unit = 0;
  for (const signals::Signal& signal : signals) {
    name = std::max(name, signal.name.size());
    unit = std::max(unit, signal.unit.size());
  }
  std::string text;
  for (const signals::Signal& signal : signals) {
    text += fmt::format("{:<{}}  {:<{}}  {}", signal.name, name, signal.unit, unit, signal.meaning);
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  text += kMore;
  return text;
}

}  // namespace ipos::tools
