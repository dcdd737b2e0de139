// What a system command does to the variables that are followed, and who is told of it.
#include <algorithm>

#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/constant_flow.hpp"

namespace ipos::compiler {
namespace {

using vm::Opcode;

constexpr uint32_t kWordsOfMldata = 8;

}  // namespace

void ConstantFlow::command(const checked::Expr& expr, const checked::SystemCall& node) {
  if (state_.reached && budget_ != 0) (*visit_)({expr, node, function_, root_});
  const auto word = [&](size_t argument) { return std::get<int32_t>(node.arguments[argument]); };
  switch (node.opcode) {
    case Opcode::WdOnK: return store(kWatchdog, sets_.of({word(0), expr.span}));
    case Opcode::WdOnH: return store(kWatchdog, KnownValues::kAny);
    case Opcode::WdOff: return store(kWatchdog, sets_.of({kWatchdogOff, expr.span}));
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
