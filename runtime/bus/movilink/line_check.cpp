// The rules of the line, from what is heard on it.
#include "runtime/bus/movilink/line_check.hpp"

#include <fmt/format.h>

#include <utility>

namespace ipos::runtime {

void LineCheck::on_character(const Rs485Line& line, NodeId sender, const Character& character) {
  if (const auto reception = receiver_.take(character)) take(line, sender, *reception);
}

void LineCheck::on_serial_event(const Rs485Line& line, const SerialEvent& event) {
  if (event.kind == SerialEventKind::Collision) collision_ = event;
  if (event.fault && !told_.emplace(event.node, *event.fault).second) return;
  report_(event.time, describe(line, event));
}

void LineCheck::take(const Rs485Line& line, NodeId sender, const Reception& reception) {
  const bool request = reception.bytes.size > 0 && reception.bytes.data[0] == kRequestStart;
  if (request && sender == kNoNode && collision_)
    check_masters(line, collision_->other, collision_->node, reception.end);
  if (sender != kNoNode) collision_.reset();
  if (!reception.telegram) {
    if (request && reception.telegram.error() == SerialError::Gap) broken_off_ = reception.end;
    return;
  }
  ++telegrams_;
  if (!request) return;
  if (sender != kNoNode) {
    if (!master_) master_ = sender;
    check_masters(line, *master_, sender, reception.end);
  }
  check_pauses(line, reception);
  broadcast_end_.reset();
  broken_off_.reset();
  if (address_kind(reception.telegram->address) == AddressKind::Broadcast) broadcast_end_ = reception.end;
}

void LineCheck::check_masters(const Rs485Line& line, NodeId one, NodeId other, Time now) {
  if (one == other) return;
  report_(now, fmt::format("{}: {} and {} are both masters; only one may be active (1053 1610 p. 47)",
                           line.name(), line.node_name(one), line.node_name(other)));
}

void LineCheck::check_pauses(const Rs485Line& line, const Reception& reception) {
  const auto check = [&](const std::optional<Time>& since, Time pause, const char* after) {
    if (!since || reception.start - *since >= pause) return;
    report_(reception.end,
            fmt::format("{}: a request begins {} us after {}, at least {} us are required", line.name(),
                        (reception.start - *since) / kMicrosecond, after, pause / kMicrosecond));
  };
  check(broadcast_end_, kBroadcastPause, "a broadcast");
  check(broken_off_, kAbortPause, "a request that was broken off");
}

}  // namespace ipos::runtime
