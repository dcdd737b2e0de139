// Which variables are followed, which roots write them, and what they hold at first.
#include <algorithm>

#include "compiler/sema/command_writes.hpp"
#include "compiler/sema/constant_flow.hpp"
#include "compiler/sema/expressions.hpp"
#include "compiler/sema/walk.hpp"

namespace ipos::compiler {
namespace {

constexpr int kRounds = 4;  // variables of variables of ... that a member is computed from

}  // namespace

void ConstantFlow::follow(uint32_t number) {
  if (number >= slots_.size() || slots_[number] != kNotFollowed) return;
  slots_[number] = static_cast<uint32_t>(numbers_.size());
  numbers_.push_back(number);
}

void ConstantFlow::follow_sources(const checked::Expr& expr) {
  if (const auto* copy = std::get_if<checked::CopyBlock>(&expr.node)) {
    for (uint32_t n = 0; n < copy->count; ++n)
      if (slots_[copy->target + n] != kNotFollowed) follow(copy->source + n);
    return;
  }
  const auto* assign = std::get_if<checked::Assign>(&expr.node);
  if (assign == nullptr || assign->target.offset != nullptr ||
      slots_[static_cast<uint32_t>(assign->target.number)] == kNotFollowed)
    return;
  checked::walk(assign->value, [&](const checked::Expr& inner) {
    const auto* load = std::get_if<checked::Load>(&inner.node);
    if (load != nullptr && load->place.offset == nullptr) follow(static_cast<uint32_t>(load->place.number));
  });
}

void ConstantFlow::find_followed() {
  slots_.assign(kSbusStarted + 1, kNotFollowed);
  for (size_t n = 0; n < program_.functions.size(); ++n) {
    if (!roots_.alive[n]) continue;
    for (const checked::Expr* expr : contents_[n].calls) {
      const auto* call = std::get_if<checked::SystemCall>(&expr->node);
      if (call == nullptr) continue;
      if (call->opcode == vm::Opcode::WaitH || call->opcode == vm::Opcode::WdOnH)
        checked::walk(*expr, [&](const checked::Expr& inner) {
          const auto* load = std::get_if<checked::Load>(&inner.node);
          if (load != nullptr && load->place.offset == nullptr) follow(static_cast<uint32_t>(load->place.number));
        });
      const OrderBlock orders = order_block(*call);
      for (uint32_t m = 0; m < orders.size; ++m) follow(orders.first + m);
      if (call->opcode == vm::Opcode::Scom && orders.result)
        read_only_takers_.insert(orders.first + orders.size - 2);  // DPointer of what is sent
      if (call->opcode == vm::Opcode::VarInt) read_only_takers_.insert(orders.first + 2);  // SrcVar
    }
  }
  follow(kWatchdog);
  follow(kSbusStarted);
  for (int round = 0; round < kRounds; ++round) {
    const size_t before = numbers_.size();
    for (size_t n = 0; n < program_.functions.size(); ++n)
      if (roots_.alive[n])
        for (const checked::Expr* expr : contents_[n].expressions) follow_sources(*expr);
    if (numbers_.size() == before) break;
  }
}

void ConstantFlow::note_write(uint32_t number, uint32_t count, size_t function, Set value) {
  for (uint32_t n = number; n < number + count && n < slots_.size(); ++n) {
    const uint32_t slot = slots_[n];
    if (slot == kNotFollowed) continue;
    relevant_[function] = true;
    for (const size_t root : roots_.of[function]) writers_[slot] |= uint64_t{1} << std::min<size_t>(root, 63);
    all_[slot] = sets_.join(all_[slot], value);
  }
}

void ConstantFlow::note_writes(const checked::Expr& expr, size_t function) {
  const auto place = [&](const checked::Place& at, const std::optional<NumberRange>& within, Set value) {
    if (at.offset == nullptr)
      note_write(static_cast<uint32_t>(at.number), 1, function, value);
    else if (within)
      note_write(within->low, within->size(), function, KnownValues::kAny);
  };
  if (const auto* node = std::get_if<checked::Step>(&expr.node)) place(node->place, node->within, KnownValues::kAny);
  if (const auto* node = std::get_if<checked::Assign>(&expr.node)) {
    const int32_t* constant = node->op ? nullptr : constant_value(node->value);
    place(node->target, node->within, constant != nullptr ? sets_.of({*constant, expr.span}) : KnownValues::kAny);
  }
  if (const auto* node = std::get_if<checked::CopyBlock>(&expr.node))
    note_write(node->target, node->count, function, KnownValues::kAny);
  const auto* call = std::get_if<checked::SystemCall>(&expr.node);
  if (call == nullptr) return;
  relevant_[function] = true;
  switch (call->opcode) {
    case vm::Opcode::WdOnK:
    case vm::Opcode::WdOnH:
    case vm::Opcode::WdOff: return note_write(kWatchdog, 1, function, KnownValues::kAny);
    case vm::Opcode::ScomOn:
    case vm::Opcode::ScomState: return note_write(kSbusStarted, 1, function, KnownValues::kAny);
    default:
      return written_blocks(*call, [&](uint32_t first, uint32_t count) {
        note_write(first, count, function, KnownValues::kAny);
      });
  }
}

// 0 of a global that is lost at power-off; what `initial`, an alias or a kept number holds, others may have written.
ConstantFlow::Set ConstantFlow::zero(const Context& context, uint32_t number, KnownValues& sets) {
  if (number == kSbusStarted) return sets.of({0, {}});
  if (number == kWatchdog) return sets.of({kWatchdogOff, {}});
  if (number <= kLastNonVolatile || number >= stdlib::kFirstSystemVariable) return KnownValues::kAny;
  for (const Variable& variable : context.scope.variables())
    if (variable.storage == Storage::Global && number >= variable.number &&
        number < variable.number + variable.type.size())
      return sets.of({0, {}});
  return KnownValues::kAny;
}

void ConstantFlow::find_owners(const Context& context) {
  const size_t count = numbers_.size();
  writers_.assign(count, 0);
  relevant_.assign(program_.functions.size(), false);
  pinned_.assign(count, false);
  for (size_t slot = 0; slot < count; ++slot) {
    at_first_.push_back(zero(context, numbers_[slot], sets_));
    all_.push_back(at_first_.back());
    const auto found = context.accesses.find(numbers_[slot]);
    if (found == context.accesses.end()) continue;
    for (const AccessPlace& taken : found->second.takers)
      if (!read_only_takers_.contains(taken.into)) pinned_[slot] = true;
  }
  for (size_t n = 0; n < program_.functions.size(); ++n)
    if (roots_.alive[n])
      for (const checked::Expr* expr : contents_[n].expressions) note_writes(*expr, n);
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t n = 0; n < relevant_.size(); ++n)
      for (const Reference& reference : roots_.graph[n])
        if (!relevant_[n] && reference.kind == ReferenceKind::Call && relevant_[reference.function])
          relevant_[n] = changed = true;
  }
}

ConstantFlow::ConstantFlow(const Context& context, const ProgramRoots& roots)
    : program_(context.program), contents_(context.contents), roots_(roots) {
  find_followed();
  find_owners(context);
}

}  // namespace ipos::compiler
