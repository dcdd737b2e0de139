// What a line tells: events in words, and its load.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "runtime/bus/can/identifier_text.hpp"
#include "runtime/bus/can/line.hpp"

namespace ipos::runtime {
namespace {

constexpr std::string_view kEventTexts[] = {
#define LINE_EVENT(name, text) text,
#include "runtime/bus/can/line_events.def"
};

// "sbus: planted fault 'swap': unit2 has high and low interchanged", "... 'cut' is over: the line is cut
// after unit1"
std::string describe_fault(const CanLine& line, const LineEvent& event) {
  const FaultType& type = kFaultTypes[event.fault];
  const bool over = event.kind == LineEventKind::FaultEnds;
  std::string text =
      fmt::format("{}: {}fault '{}'{}: {} {}", line.name(), event.of_line ? "" : "planted ", type.word, over ? " is over" : "",
                  event.node == kNoNode ? "the line" : line.node_name(event.node), type.text);
  if (event.other != kNoNode) text += " behind " + line.node_name(event.other);
  if (event.kind == LineEventKind::FaultStrikes && static_cast<FaultKind>(event.fault) == FaultKind::Baud)
    text += fmt::format(" ({} kbaud, line {} kbaud)", event.id / 1000, line.baud() / 1000);
  if (type.scope == FaultScope::Frame) text += fmt::format(", identifier {}", id_words(event.id));
  return text;
}

}  // namespace

void CanLine::add_observer(CanObserver& observer) {
  frame_observers_.push_back(&observer);
  add_observer(static_cast<LineObserver&>(observer));
}

void CanLine::add_observer(LineObserver& observer) {
  observers_.push_back(&observer);
  for (NodeId node = 0; node < nodes_.size(); ++node) report_absence(node, &observer);
}

void CanLine::report(const LineEvent& event) {
  for (LineObserver* observer : observers_) observer->on_line_event(*this, event);
}

void CanLine::report_error(const FrameRecord& frame, bool unacknowledged) {
  const ErrorRecord error{frame.start, frame.end, frame.bits, unacknowledged};
  for (CanObserver* observer : frame_observers_) observer->on_error_frame(*this, error);
}

void CanLine::report_absence(NodeId node, LineObserver* only) {
  const Node& n = nodes_[node];
  if (n.connected && n.rate() == baud_) return;
  const LineEvent event{n.connected ? LineEventKind::WrongBaudRate : LineEventKind::NotConnected,
                        queue_.now(), node};
  if (only != nullptr)
    only->on_line_event(*this, event);
  else
    report(event);
}

// --- load

LineLoad CanLine::load(Time now) const {
  LoadMeter meter = meter_;
  repeats_.count(meter, repeats_.ended(passed_bit()));
  LineLoad load = meter.load(static_cast<uint64_t>(now / bit_time_));
  load.frames = frames_;
  return load;
}

std::string describe(const CanLine& line, const LineEvent& event) {
  if (event.kind == LineEventKind::FaultStrikes || event.kind == LineEventKind::FaultEnds)
    return describe_fault(line, event);
  std::string text = fmt::format("{}: {} {}", line.name(), line.node_name(event.node),
                                 kEventTexts[static_cast<size_t>(event.kind)]);
  switch (event.kind) {
    case LineEventKind::WrongBaudRate:
      text +=
          fmt::format(" ({} kbaud, line {} kbaud)", line.node_baud(event.node) / 1000, line.baud() / 1000);
      break;
    case LineEventKind::NoAcknowledge: text += fmt::format(", identifier {}", id_words(event.id)); break;
    case LineEventKind::Collision:
    case LineEventKind::SameFrame:
      assert(event.other != kNoNode);  // it takes two
      text +=
          fmt::format(", identifier {}, other station {}", id_words(event.id), line.node_name(event.other));
      break;
    case LineEventKind::AllSendTheSame:
      text += fmt::format(", identifier {}, {} stations from {} to {}", id_words(event.id), event.senders,
                          line.node_name(event.node), line.node_name(event.other));
      break;
    default: break;
  }
  return text;
}

}  // namespace ipos::runtime
