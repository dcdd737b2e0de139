// What a slave does with what it hears, in time.
#include "runtime/bus/profibus/slave_station.hpp"

#include <algorithm>
#include <utility>

namespace ipos::profibus {

SlaveStation::SlaveStation(runtime::EventQueue& queue, uint32_t source, Line& line, std::string name,
                           const OptionType& option, CardSwitches switches, SlaveUnit& unit,
                           SlaveObserver* observer)
    : queue_(queue),
      source_(source),
      line_(line),
      option_(option),
      observer_(observer),
      switches_(switches),
      slave_(switches_.slave_settings(option, line.baud()), unit, observer),
      node_(line.attach(std::move(name), *this)) {
  search_rate();
}

void SlaveStation::search_rate() {
  rate_.begin();
  line_.listen_at(node_, rate_.baud());
}

void SlaveStation::power_off() {
  queue_.cancel(std::exchange(watchdog_, runtime::kNoEvent));
  line_.set_connected(node_, false);
}

void SlaveStation::power_on(bool supply_was_kept) {
  switches_.power_on(supply_was_kept);
  line_.set_connected(node_, true);
  powered_at_ = queue_.now();
  slave_.power_on(powered_at_, switches_.slave_settings(option_, line_.baud()));
  queue_.cancel(std::exchange(watchdog_, runtime::kNoEvent));
  search_rate();
}

void SlaveStation::on_reception(Time now, const Reception& reception) {
  if (!reception.frame) {
    if (rate_.heard_error(now)) line_.listen_at(node_, rate_.baud());
    return;
  }
  if (!rate_.heard_frame() || hardware_ != HardwareFault::None) return;
  const auto answer = slave_.on_frame(now, *reception.frame);
  if (answer) line_.send(node_, line_.now() + std::max<Bits>(slave_.min_tsdr(), reaction_), *answer);
  watch();
}

// With a fault of its bus connection it does not answer (ours); without the link it does, and services fail.
void SlaveStation::on_fault(Time now, OctetFaultKind kind, bool on) {
  if (kind == OctetFaultKind::Link && observer_ != nullptr) observer_->on_link(now, on);
  if (kind == OctetFaultKind::Diagnosis) slave_.set_static_diagnosis(on);
  if (kind == OctetFaultKind::Card) hardware_ = on ? HardwareFault::GreenDark : HardwareFault::None;
  if (kind == OctetFaultKind::CardFlash) hardware_ = on ? HardwareFault::BothFlash : HardwareFault::None;
}

// The deadline moves away with each request: the event that stands finds the new one by itself.
void SlaveStation::watch() {
  const Time deadline = slave_.watchdog_deadline();
  if (watchdog_ != runtime::kNoEvent && watchdog_at_ <= deadline) return;
  queue_.cancel(std::exchange(watchdog_, runtime::kNoEvent));
  if (deadline == runtime::kNever) return;
  watchdog_ = queue_.schedule(deadline, source_, *this, 0);
  watchdog_at_ = deadline;
}

void SlaveStation::on_event(Time now, uint32_t, uint64_t) {
  watchdog_ = runtime::kNoEvent;
  if (now >= slave_.watchdog_deadline()) {
    slave_.expire(now);
    search_rate();
  }
  watch();
}

CardState SlaveStation::card_state(Time now) const {
  CardState state;
  state.hardware = hardware_;
  state.initialising = option_.fms && now - powered_at_ < kInitialisation;
  state.address_valid = switches_.address() <= kLastStation;
  state.exchanging = slave_.state() == SlaveState::DataExchange;
  if (option_.fms && !slave_.was_parameterised())
    state.used_as = UsedAs::Fms;
  else if (option_.fms && switches_.fms())
    state.used_as = UsedAs::Both;
  return state;
}

}  // namespace ipos::profibus
