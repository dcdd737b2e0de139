// What a system command does to the variables that are followed, and who is told of it.
#include <algorithm>

#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/constant_flow.hpp"

namespace ipos::compiler {
namespace {

using vm::Opcode;

constexpr uint32_t kWordsOfMldata = 8;

}  // namespace

// Waits take time from a watchdog. Where ways meet, the most that one of them leaves is what can be said.
ConstantFlow::Set ConstantFlow::join_watchdog(Set a, Set b) {
  if (a == b) return a;
  if (a == KnownValues::kAny || b == KnownValues::kAny) return KnownValues::kAny;
  std::vector<KnownValue> all;
  for (const Set set : {a, b})
    for (const KnownValue& known : sets_.values(set)) {
      const auto same = std::find_if(all.begin(), all.end(), [&](const KnownValue& one) { return one.span == known.span; });
      if (same == all.end())
        all.push_back(known);
      else
        same->value = std::max(same->value, known.value);
    }
  Set joined = sets_.of(all.front());
  for (const KnownValue& known : all) joined = sets_.join(joined, sets_.of(known));
  return joined;
}

// WDON starts it; a value that is written counts while it runs only.
void ConstantFlow::set_watchdog(Set value) {
  ++feeds_;
  const std::span<const KnownValue> before = values(kWatchdog);
  const auto off = [](const KnownValue& known) { return known.value == kWatchdogOff; };
  if (!before.empty() && std::all_of(before.begin(), before.end(), off)) return;
  store(kWatchdog, std::any_of(before.begin(), before.end(), off) ? KnownValues::kAny : value);
}

void ConstantFlow::pass_time(int32_t ms) {
  const std::span<const KnownValue> before = values(kWatchdog);
  if (ms <= 0 || before.empty()) return;
  Set after = KnownValues::kAny;
  for (const KnownValue& known : before) {
    if (known.value >= 0 && known.value < ms) return store(kWatchdog, KnownValues::kAny);  // fault F41
    const Set left = sets_.of({known.value < 0 ? known.value : known.value - ms, known.span});
    after = after == KnownValues::kAny ? left : sets_.join(after, left);
  }
  store(kWatchdog, after);
}

void ConstantFlow::tell_unfed(Set watchdog, Span loop) const {
  const std::span<const KnownValue> all = sets_.values(watchdog);
  const bool runs = std::all_of(all.begin(), all.end(), [](const KnownValue& known) { return known.assigned() && known.value >= 0; });
  if (state_.reached && budget_ != 0 && !all.empty() && runs) (*unfed_)({all, loop});
}

void ConstantFlow::command(const checked::Expr& expr, const checked::SystemCall& node, Set value) {
  if (state_.reached && budget_ != 0) (*visit_)({expr, node, function_, root_, value});
  const auto word = [&](size_t argument) { return std::get<int32_t>(node.arguments[argument]); };
  switch (node.opcode) {
    case Opcode::WdOnK: ++feeds_; return store(kWatchdog, sets_.of({word(0), expr.span}));
    case Opcode::WdOnH: {
      const KnownValue* known = sets_.only(value);
      ++feeds_;
      return store(kWatchdog, known != nullptr ? sets_.of({known->value, expr.span}) : KnownValues::kAny);
    }
    case Opcode::WdOff: ++feeds_; return store(kWatchdog, sets_.of({kWatchdogOff, expr.span}));
    case Opcode::WaitK: return pass_time(word(0));
    case Opcode::WaitH:
      if (const KnownValue* known = sets_.only(value)) pass_time(known->value);
      return;
    case Opcode::ScomOn: return store(kSbusStarted, sets_.of({1, expr.span}));
    case Opcode::ScomState: return store(kSbusStarted, sets_.of({word(0) == 1, expr.span}));
    case Opcode::Scom: define(expr, node); break;
    case Opcode::Movlnk:
      if (const KnownValue* data = only(order_block(node).first + 5); data != nullptr && data->value >= 0)
        forget(static_cast<uint32_t>(data->value), kWordsOfMldata);
      break;
    case Opcode::InputCall:
    case Opcode::SystemCall: {
      const State before = state_;
      call(std::get<checked::FunctionRef>(node.arguments.back()).function);
      return join(state_, before);
    }
    default: break;
  }
  written_blocks(node, [&](uint32_t first, uint32_t count) { forget(first, count); });
}

void ConstantFlow::define(const checked::Expr& expr, const checked::SystemCall& node) {
  const uint32_t first = order_block(node).first;
  const KnownValue* object = only(first);
  if (object == nullptr || !state_.reached) return;
  const Defined defined{object->value, first, expr.span};
  if (std::find(state_.defined.begin(), state_.defined.end(), defined) == state_.defined.end())
    state_.defined.push_back(defined);
}

}  // namespace ipos::compiler
