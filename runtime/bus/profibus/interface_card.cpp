// Wiring of the parts.
#include "runtime/bus/profibus/interface_card.hpp"

#include <utility>

namespace ipos::profibus {
namespace {

bool is_mc31(const OptionType& option) { return option.accepts.set == ConfigurationSet::Mc31; }

}  // namespace

InterfaceCard::InterfaceCard(runtime::EventQueue& queue, uint32_t source, Line& line, std::string name,
                             const OptionType& option, CardSwitches switches,
                             runtime::ParameterServer& inverter, const stdlib::ParameterTable& table,
                             FieldbusDrive& drive, SlaveObserver* observer)
    : drive_(drive),
      parameters_(inverter, table),
      unit_(is_mc31(option) ? DpUnit(parameters_, drive) : DpUnit(inverter, drive)),
      station_(queue, source, line, std::move(name), option, switches, unit_, observer) {
  if (is_mc31(option)) {
    objects_.emplace(parameters_, drive, station_.slave());
    fms_.emplace(*objects_, option.fms);
    links_.emplace(*fms_);
    if (option.fms) station_.slave().set_fms(*links_);
  }
  drive_.set_fieldbus_address(queue.now(), station_.switches().address());
}

void InterfaceCard::power_on(Time now, bool supply_was_kept) {
  station_.power_on(supply_was_kept);
  if (fms_) {
    objects_->power_on();
    fms_->power_on();
    links_->power_on();
  }
  drive_.set_fieldbus_address(now, station_.switches().address());
}

LedPattern InterfaceCard::leds(Time now) const {
  CardState state = station_.card_state(now);
  state.fms_connected = fms_ && fms_->connected(now);
  const auto accessed = unit_.accessed();
  state.accessing = (fms_ && fms_->busy()) || (accessed && now - *accessed < kFlicker);
  return profibus::leds(state);
}

}  // namespace ipos::profibus
