// Wiring of the parts.
#include "runtime/bus/profibus/interface_card.hpp"

#include <utility>

namespace ipos::profibus {

InterfaceCard::InterfaceCard(runtime::EventQueue& queue, uint32_t source, Line& line, std::string name,
                             const OptionType& option, CardSwitches switches,
                             runtime::ParameterServer& inverter, const stdlib::ParameterTable& table,
                             FieldbusDrive& drive, SlaveObserver* observer)
    : drive_(drive),
      parameters_(inverter, table),
      unit_(parameters_, drive),
      station_(queue, source, line, std::move(name), option, switches, unit_, observer),
      objects_(parameters_, drive, station_.slave()),
      fms_(objects_, option) {
  drive_.set_fieldbus_address(queue.now(), station_.switches().address());
}

void InterfaceCard::power_on(Time now, bool supply_was_kept) {
  station_.power_on(supply_was_kept);
  objects_.power_on();
  fms_.power_on();
  drive_.set_fieldbus_address(now, station_.switches().address());
}

LedPattern InterfaceCard::leds(Time now) const {
  CardState state = station_.card_state(now);
  state.fms_connected = fms_.connected();
  const auto accessed = unit_.accessed();
  state.accessing = fms_.busy() || (accessed && now - *accessed < kFlicker);
  return profibus::leds(state);
}

}  // namespace ipos::profibus
