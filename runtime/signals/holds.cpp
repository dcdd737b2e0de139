// An input is held by its line; everything else is written again.
#include "runtime/signals/holds.hpp"

#include <algorithm>
#include <utility>

namespace ipos::signals {

Hold& Holds::hold(const Signal& signal, int32_t value, std::string_view by) {
  auto held = std::find_if(all_.begin(), all_.end(), [&](const Hold& other) { return other.signal.same_as(signal); });
  if (held == all_.end()) held = all_.insert(held, Hold{signal, {}, {}, {}});  // the rest follows
  held->value = value;
  held->number = ++made_;
  held->by = by;
  if (signal.is_input()) signal.line().forced = value;
  return *held;
}

void Holds::release(const Signal& signal) {
  for (size_t n = all_.size(); n-- > 0;)
    if (all_[n].signal.shares_terminal(signal)) end(n);
  if (signal.is_input() && std::as_const(*signal.owner).inputs().line(signal.number).forced) signal.line().forced.reset();
}

void Holds::release(uint64_t number) {
  for (size_t n = all_.size(); n-- > 0;)
    if (all_[n].number == number) end(n);
}

void Holds::end(size_t n) {
  const Hold ended = std::move(all_[n]);
  all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(n));
  if (ended.signal.is_input()) ended.signal.line().forced.reset();
  if (ended.before) write(ended.signal, *ended.before);
}

void Holds::act() {
  for (const Hold& held : all_)
    if (held.signal.group == Group::ProcessData || held.signal.read() != held.value) write(held.signal, held.value);
}

const Hold* Holds::find(const Signal& signal) const {
  const auto held = std::find_if(all_.begin(), all_.end(), [&](const Hold& other) { return other.signal.same_as(signal); });
  return held == all_.end() ? nullptr : &*held;
}

void Holds::write(const Signal& signal, int32_t value) const {
  if (auto refused = signal.put(*signal.owner, signal.number, value)) refused_(signal, *std::move(refused));
}

bool is_forced(const Holds& holds, const Signal& signal) {
  if (holds.find(signal) != nullptr) return true;
  return signal.is_input() && signal.owner != nullptr &&
         std::as_const(*signal.owner).inputs().line(signal.number).forced.has_value();
}

}  // namespace ipos::signals
