// What nodes tell the line, and the line them: FMI-LS-BUS 1.0, chapter "CAN, CAN FD, CAN XL".
#include "runtime/fmi/line_terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/fmi/can_operations.hpp"

namespace ipos::fmi {
namespace {

using library::Act;
using library::CanNodes;
using library::NodeNews;

// A sender that sees other bits than its own has found a bit error, and is the first to notice; the others hear of it (table of the
// error codes).
std::string error_operation(const NodeNews& news) {
  const BusErrorCode code = news.why == runtime::NotSent::NoAcknowledge ? BusErrorCode::Acknowledge : BusErrorCode::Bit;
  return bus_error_operation(news.frame.id, code, news.own, news.own);
}

std::string operation_of(const NodeNews& news) {
  switch (news.kind) {
    case NodeNews::Kind::Received: return transmit_operation(news.frame);
    case NodeNews::Kind::Sent: return confirm_operation(news.frame.id);
    case NodeNews::Kind::Lost: return arbitration_lost_operation(news.frame.id);
    default: return error_operation(news);
  }
}

class LineTerminal final : public BusTerminal {
 public:
  LineTerminal(std::string name, size_t number, size_t count) : BusTerminal(std::move(name)), number_(number), count_(count) {}

  bool is_of_the_line() const override { return true; }

  void begin(library::Session& session) override {
    buffers = {};
    buffers.notified = true;
    fetched = false;
    announced.reset();
    if (number_ == 0) perform(session, Act::NodesJoin, static_cast<int64_t>(count_));
  }

  bool collect(library::Session& session) override {
    auto& heard = session.instance().can()[0]->heard();  // nobody asks for it here
    while (heard.take()) continue;
    auto& news = nodes(session).news(number_);
    while (const auto one = news.take()) put_out(operation_of(*one));
    return !buffers.out.empty();
  }

  runtime::Time next_time(library::Session& session) const override {
    const runtime::Time now = session.plant().now(), next = session.plant().next_time();
    runtime::CanLine& line = nodes(session).line();
    if (!buffers.out.empty()) return now;
    if (const auto end = line.plain_end()) return *end;
    if (next > now) return next;
    // Before the first step the beginning of the plant is in front of all: who waits begins with the first bit.
    for (runtime::NodeId node = 0; node < line.node_count(); ++node)
      if (line.has_waiting(node)) return now + line.bit_time();
    return runtime::kNever;
  }

  void forget_heard(library::Session& session) const override {
    auto& news = nodes(session).news(number_);
    while (news.take()) continue;
  }

 private:
  static CanNodes& nodes(library::Session& session) { return *session.instance().nodes(0); }

  library::Refusal perform(library::Session& session, Act act, int64_t value, std::vector<uint8_t> bytes = {}) const {
    library::Action action;
    action.act = act;
    action.signal.number = static_cast<uint32_t>(number_);
    action.value = value;
    action.bytes = std::move(bytes);
    return session.perform(std::move(action));
  }

  void act(const ReadOperation& operation, library::Session& session, Taken& taken) override {
    library::Refusal refused;
    switch (operation.kind) {
      case CanOperation::Transmit:
        refused = perform(session, Act::NodeSend, 0, library::frame_bytes(runtime::canonical(operation.frame)));
        break;
      case CanOperation::Configuration:
        if (operation.baud != 0) refused = perform(session, Act::NodeRate, operation.baud);
        if (operation.discards) perform(session, Act::NodeDiscards, *operation.discards ? 1 : 0);
        break;
      case CanOperation::Status: perform(session, Act::NodeState, static_cast<int64_t>(operation.state)); break;
      case CanOperation::Wakeup: taken.wakes = true; break;
      default: break;  // what only a line tells, or an answer
    }
    if (refused) taken.wrong.push_back(operation.kind == CanOperation::Transmit
                                           ? fmt::format("{:X}h is not sent: {}", operation.id, *refused)
                                           : *refused);
  }

  size_t number_, count_;
};

}  // namespace

Terminals terminals_of_line(const LineChoice& line) {
  Terminals terminals;
  for (size_t n = 0; n < line.terminals; ++n)
    terminals.push_back(std::make_unique<LineTerminal>(fmt::format("{}.node{}", line.bus, n + 1), n, line.terminals));
  return terminals;
}

}  // namespace ipos::fmi
