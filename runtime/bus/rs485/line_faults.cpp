// Planted faults of the line that last, and what it reports in words.
#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/rs485/line.hpp"

namespace ipos::runtime {
namespace {

uint32_t other_rate(uint32_t baud) { return baud == kSerialBaudRates[0] ? kSerialBaudRates[1] : kSerialBaudRates[0]; }

}  // namespace

void Rs485Line::add_fault(const OctetFault& fault) {
  const size_t number = planted_.add(fault);
  if (octet_fault_type(fault.kind).scope == OctetFaultScope::Frame) return;  // strikes by itself
  queue_.schedule(std::max(fault.from, queue_.now()), source_, *this, kFaultBegins, number);
  if (fault.until != kNever) queue_.schedule(fault.until, source_, *this, kFaultEnds, number);
}

bool Rs485Line::end_fault(OctetFaultKind kind, NodeId sender) {
  const Time now = queue_.now();
  if (!planted_.end(kind, sender, now)) return false;
  if (octet_fault_type(kind).scope == OctetFaultScope::Station) switch_fault(now, {kind, 0, now, sender}, false);
  return true;
}

void Rs485Line::switch_fault(Time now, const OctetFault& fault, bool on) {
  if (!on && planted_.lasts(fault.kind, fault.sender, now)) return;  // another one goes on
  if (on) report({SerialEventKind::Fault, now, fault.sender, kNoNode, fault.kind});
  Node& node = nodes_[fault.sender];
  if (fault.kind == OctetFaultKind::Swap) {
    node.ear.swapped = on;
    restart_receiver(fault.sender);
  }
  if (fault.kind == OctetFaultKind::Baud) {
    node.wrong_rate = on;
    take_rate(fault.sender);
  }
}

// There are two rates, so a wrong one is the other.
void Rs485Line::take_rate(NodeId node) {
  Node& n = nodes_[node];
  n.ear.bit_ticks = ticks_per_bit(n.wrong_rate ? other_rate(n.baud) : n.baud);
  restart_receiver(node);
}

std::string describe(const Rs485Line& line, const SerialEvent& event) {
  static constexpr std::string_view kTexts[] = {
#define SERIAL_EVENT(name, text) text,
#include "runtime/bus/rs485/line_events.def"
  };
  std::string text = fmt::format("{}: {} {}", line.name(), line.node_name(event.node),
                                 kTexts[static_cast<size_t>(event.kind)]);
  if (event.kind == SerialEventKind::Fault)
    return fmt::format("{}: {} {}", line.name(), line.node_name(event.node), octet_fault_type(*event.fault).text);
  if (event.fault) text += fmt::format(": the line {}", octet_fault_type(*event.fault).text);
  if (event.kind == SerialEventKind::WrongBaudRate)
    text += fmt::format(" ({} baud, line {} baud)", line.node_baud(event.node), line.baud());
  if (event.kind == SerialEventKind::Collision)
    text += fmt::format(" (other station {})", line.node_name(event.other));
  return text;
}

}  // namespace ipos::runtime
