// Guarding and heartbeat. Supervision begins with the first request or heartbeat after the setting, and what
// was missed ends with the next one, or when supervision is switched off (the latter ours).
#include "runtime/bus/canopen/error_control.hpp"

#include <utility>

namespace ipos::runtime::canopen {
namespace {

enum ErrorControlTimer : uint32_t { kProduce, kGuard, kConsume };

constexpr uint8_t kToggleBit = 0x80;

}  // namespace

ErrorControl::ErrorControl(const Place& place, const ObjectDictionary& dictionary, const State& state,
                           Listener& listener)
    : place_(place),
      dictionary_(dictionary),
      state_(state),
      listener_(listener),
      produce_(place, *this, kProduce),
      guard_(place, *this, kGuard),
      consume_(place, *this, kConsume) {}

void ErrorControl::send(uint8_t byte) {
  place_.sender.send({identifier(Connection::ErrorControl, dictionary_.node()), 1, {byte}}, place_.tag);
}

void ErrorControl::boot_up(Time now) {
  toggle_ = 0;
  period_ = life_time_ = partner_time_ = 0;
  produce_.stop();
  guard_.stop();
  consume_.stop();
  miss(now, kGuard, false);
  miss(now, kConsume, false);
  send(static_cast<uint8_t>(State::BootUp));
  configure(now);
}

void ErrorControl::configure(Time now) {
  const auto milliseconds = [&](uint16_t index) { return Time{dictionary_.value(index)} * kMillisecond; };
  if (const Time period = milliseconds(objects::kProducerHeartbeat);
      std::exchange(period_, period) != period) {
    produce_.stop();
    if (period > 0) on_timer(now, kProduce);
  }
  const Time life_time = milliseconds(objects::kGuardTime) * dictionary_.value(objects::kLifeFactor);
  if (std::exchange(life_time_, life_time) != life_time) guard_.stop();
  if (life_time == 0) miss(now, kGuard, false);
  const uint32_t consumer = dictionary_.value(objects::kConsumerHeartbeat, 1);
  const Time partner_time = Time{consumer & 0xFFFF} * kMillisecond;
  const auto partner = static_cast<uint8_t>(consumer >> 16);
  const bool awaited = partner_time > 0 && is_node(partner);
  const std::optional<uint8_t> before = partner_;
  partner_ = awaited ? std::optional(partner) : std::nullopt;
  if (partner_ == before && partner_time == partner_time_) return;
  partner_time_ = partner_time;
  consume_.stop();
  if (!partner_) miss(now, kConsume, false);
}

bool ErrorControl::on_remote(Time now) {
  if (period_ > 0) return false;
  send(static_cast<uint8_t>(static_cast<uint8_t>(state_) | toggle_));
  toggle_ ^= kToggleBit;
  if (life_time_ > 0) guard_.start(now + life_time_);
  miss(now, kGuard, false);
  return true;
}

void ErrorControl::on_heartbeat(Time now) {
  consume_.start(now + partner_time_);
  miss(now, kConsume, false);
}

void ErrorControl::on_timer(Time now, uint32_t kind) {
  if (kind != kProduce) return miss(now, kind, true);
  send(static_cast<uint8_t>(state_));
  produce_.start(now + period_);
}

void ErrorControl::miss(Time now, uint32_t kind, bool lost) {
  const uint32_t before = missed_;
  missed_ = lost ? missed_ | 1U << kind : missed_ & ~(1U << kind);
  if ((before == 0) != (missed_ == 0)) listener_.on_partner(now, lost);
}

}  // namespace ipos::runtime::canopen
