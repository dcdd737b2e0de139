// What is kept of lines, and what is sent.
#include "runtime/library/bus_tap.hpp"

#include <linux/can/error.h>

#include <algorithm>
#include <utility>

namespace ipos::library {
namespace {

// What a controller would report of an event; 0: nothing.
uint32_t error_classes(runtime::LineEventKind kind, std::array<uint8_t, 8>& data) {
  using Event = runtime::LineEventKind;
  switch (kind) {
    case Event::NoAcknowledge:
    case Event::AllSendTheSame: return CAN_ERR_ACK;
    case Event::Collision: return CAN_ERR_PROT;
    case Event::ErrorPassive:
      data[1] = CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_RX_PASSIVE;
      return CAN_ERR_CRTL;
    case Event::BusOff: return CAN_ERR_BUSOFF;
    case Event::Recovered: return CAN_ERR_RESTARTED;
    default: return 0;
  }
}

}  // namespace

CanTap::CanTap(runtime::CanLine& line) : line_(line) {
  line.add_observer(static_cast<runtime::CanObserver&>(*this));
}

void CanTap::join() {
  if (!node_) node_ = line_.attach("library", line_.baud(), *this);
}

Refusal CanTap::send(const runtime::Frame& frame, uint32_t tag) {
  join();
  switch (line_.send(*node_, frame, tag)) {
    case runtime::SendStatus::Queued: break;
    case runtime::SendStatus::QueueFull: return "too many frames wait to be sent";
    case runtime::SendStatus::NotActive: return "the bus is off";
    case runtime::SendStatus::InvalidFrame: return "no frame is like that";
  }
  ++queued_;
  waiting_.emplace_back(runtime::canonical(frame), tag);
  if (waiting_.size() > 2 * runtime::kSendQueueLimit) waiting_.pop_front();
  return std::nullopt;
}

void CanTap::on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) {
  Heard heard{record.end, record.frame, record.sender, 0, node_ && record.sender == *node_, false};
  if (heard.own) {
    const auto sent = std::find_if(waiting_.begin(), waiting_.end(),
                                   [&](const auto& waiting) { return waiting.first == record.frame; });
    if (sent != waiting_.end()) {
      heard.tag = sent->second;
      waiting_.erase(sent);
    }
  }
  heard_.put(heard);
}

void CanTap::on_line_event(const runtime::CanLine&, const runtime::LineEvent& event) {
  Heard heard{event.time, {}, event.node, 0, node_ && event.node == *node_, true};
  heard.frame.id = error_classes(event.kind, heard.frame.data);
  heard.frame.length = CAN_ERR_DLC;
  if (heard.frame.id != 0) heard_.put(heard);
}

SerialTap::SerialTap(runtime::Rs485Line& line) : line_(line) {
  line.add_observer(static_cast<runtime::SerialObserver&>(*this));
}

Refusal SerialTap::send(std::span<const uint8_t> bytes) {
  if (!node_) node_ = line_.attach("library", line_.baud(), *this);
  return line_.send(*node_, bytes) ? std::nullopt : Refusal("the telegram before is still being sent");
}

void SerialTap::on_character(const runtime::Rs485Line&, NodeId, const runtime::Character& character) {
  if (auto reception = receiver_.take(character)) heard_.put(*std::move(reception));
}

ProfibusTap::ProfibusTap(profibus::Line& line) : line_(line) {
  line.add_observer(static_cast<profibus::LineObserver&>(*this));
}

Refusal ProfibusTap::send(std::span<const uint8_t> octets) {
  if (!node_) node_ = line_.attach("library", *this);
  const profibus::Bits begin = line_.quiet_since() + profibus::kSynBits;
  return line_.send(*node_, begin, {octets.begin(), octets.end()})
             ? std::nullopt
             : Refusal("the frame before is still being sent");
}

void ProfibusTap::on_frame(const profibus::Line&, NodeId, const profibus::Reception& reception) {
  heard_.put(reception);
}

}  // namespace ipos::library
