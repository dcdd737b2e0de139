// The lamps of a fieldbus card (MOVITRAC 31 PROFIBUS, 2.8), and the switches of a station that a hand can turn.
#include <fmt/format.h>

#include "runtime/plant_file/state_names.hpp"
#include "runtime/signals/collector.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr uint32_t kFirstSwitch = 1000;  // beyond the numbers of the states

void add_lamp(Collector& out, std::string_view name, profibus::Light profibus::LedPattern::*lamp) {
  const Station& station = out.station();
  const auto light = [&station, lamp] { return station.profibus()->card().leds(station.now()).*lamp; };
  const auto powered = [&station] { return station.powered() && station.profibus() != nullptr; };
  Signal& lit = out.add(Group::State, name, "1 while the lamp of the card is lit", [&station, light, powered]() -> int64_t {
    return powered() && profibus::is_lit(light(), station.now()) ? 1 : 0;
  });
  lit.bits = 1;
  Signal& rate = out.add(Group::State, fmt::format("{}_rate", name), "how fast the lamp flashes; 0 is steady",
                         [light, powered]() -> int64_t { return powered() ? profibus::light_rate(light()) : 0; });
  rate.unit = "Hz";
  rate.factor = 0.1;
  rate.decimals = 1;
}

}  // namespace

Refusal set_switch(Station& station, uint32_t which, int32_t value) {
  return station.set_switch(static_cast<StationSwitch>(which - kFirstSwitch), value);
}

void add_card(Collector& out) {
  const Station& station = out.station();
  if (!station.config().profibus.bus.bus.empty()) {
    add_lamp(out, "RUN", &profibus::LedPattern::green);
    add_lamp(out, "BUS_FAULT", &profibus::LedPattern::red);
  }
  for (const StationSwitchType& type : station_switches()) {
    if (!station.has_switch(type.which)) continue;
    Signal& made = out.add(Group::State, type.word, type.meaning,
                           [&station, which = type.which]() -> int64_t { return station.switch_value(which); });
    made.bits = type.most == 1 ? 1 : 0;
    made.limits = {0, type.most};
    made.number = kFirstSwitch + static_cast<uint32_t>(type.which);
    made.put = set_switch;
  }
}

}  // namespace ipos::signals
