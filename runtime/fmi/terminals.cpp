// What an instance does with its terminals: their variables, their clocks, and what comes in.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/fmi/can_operations.hpp"
#include "runtime/fmi/instance.hpp"

namespace ipos::fmi {

using runtime::Time;

std::optional<Instance::Member> Instance::member(uint32_t reference) const {
  const size_t first = variables_.all.size() + 1;
  if (reference < first || (reference - first) / kTerminalMembers >= terminals_.size()) return std::nullopt;
  const size_t place = reference - first;
  return Member{terminals_[place / kTerminalMembers].get(), static_cast<TerminalMember>(place % kTerminalMembers)};
}

// What was announced stands until the clock ticks, though it may come to nothing (FMI 3.0 chapter 2.2.9.3).
Instance::Interval Instance::interval(BusTerminal& terminal) {
  using Known = Interval::Known;
  const Time due = terminal.next_time(*session_);
  const bool is_new = due != runtime::kNever && (!terminal.announced || terminal.announced->at != due);
  if (is_new) terminal.announced = {due, std::max<Time>(0, due - std::as_const(*session_).plant().now())};
  if (!terminal.announced) return {};
  return {is_new ? Known::Changed : Known::Unchanged, terminal.announced->length};
}

Status Instance::update() {
  for (const auto& terminal : terminals_) {
    if (!std::exchange(terminal->fetched, false)) continue;
    terminal->buffers.out.clear();
    terminal->announced.reset();
  }
  for (const auto& terminal : terminals_) {
    if (!std::exchange(terminal->buffers.rx_active, false)) continue;
    const BusTerminal::Taken taken = terminal->take_in(*session_);
    for (const std::string& wrong : taken.wrong) fail(Status::Warning, kWarnings, fmt::format("{}: {}", terminal->name(), wrong));
    for (const auto& other : terminals_)
      if (taken.wakes && other != terminal) other->buffers.out += wakeup_operation();
  }
  return Status::Ok;
}

// Of the parameter BusNotifications; null: the reference is another one.
BusTerminal* Instance::notified_terminal(uint32_t reference) const {
  const auto found = member(reference);
  return found && found->kind == TerminalMember::BusNotifications ? found->terminal : nullptr;
}

// A fixed parameter of nodes; a line says that it notifies.
Status Instance::set_notified(BusTerminal& terminal, bool on) {
  if (terminal.is_of_the_line() || (stage_ != Stage::Instantiated && stage_ != Stage::Initialization))
    return fail(fmt::format("BusNotifications of {} cannot be set", terminal.is_of_the_line() ? "a line" : "a node that runs"));
  terminal.buffers.notified = on;
  return Status::Ok;
}

}  // namespace ipos::fmi
