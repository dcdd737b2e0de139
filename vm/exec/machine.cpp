// The plain interpreter: decode, do, next. It is the reference that faster engines must equal command by
// command.
#include "vm/exec/machine.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <type_traits>

#include "vm/context/arithmetic.hpp"
#include "vm/fast/engine.hpp"

namespace ipos::vm {

static_assert(std::is_trivially_copyable_v<Machine>, "a copy is a snapshot");

Machine::Machine(const VerifiedImage& program, const Host& host) : program_(program), host_(host) {}

void Machine::start() {
  stop_all();
  fault_ = {};
  contexts_ = {};
  interrupts_ = {};
  see_interrupts();
  start_task(1, 0);
}

void Machine::begin(int number, uint32_t address) {
  assert(address < program_.code().size());
  TaskContext& t = context_at(number);
  t = {};
  t.state = TaskState::Ready;
  t.pc = address;
  ++begun_;
}

void Machine::start_task(int task, uint32_t address) {
  assert(task >= 1 && task <= kTasks);
  stop_task(task);
  begin(task, address);
  context_at(task).task = static_cast<uint8_t>(task);
}

void Machine::end(TaskContext& t) {
  t.state = TaskState::Stopped;
  choose_active(t.task);
}

void Machine::stop_context(int number) {
  TaskContext& t = context_at(number);
  if (t.state == TaskState::Stopped) return;
  const bool host_waits = t.state == TaskState::Waiting && t.wait_ms == 0;
  end(t);
  if (host_waits && host_.cancel != nullptr) host_.cancel(host_.self, *this, number);
}

void Machine::stop_task(int task) {
  assert(task >= 1 && task <= kTasks);
  for (int number = 1; number <= kContexts; ++number)
    if (context(number).task == task) stop_context(number);
}

void Machine::stop_all() {
  for (int number = 1; number <= kContexts; ++number) stop_context(number);
}

// Returns how many of the budget are left in front of a command that is the reference interpreter's.
inline uint32_t Machine::run_fast(TaskContext& t, uint32_t budget) {
  if constexpr (kFastEngine)
    if (fast_ != nullptr) return fast::run(*fast_, t, h_.data(), budget, native_);
  return budget;
}

inline RunResult Machine::run_task(int task, uint32_t budget) {
  TaskContext& t = contexts_[active_[static_cast<size_t>(task - 1)]];
  if (t.state != TaskState::Ready) return run_on(task, budget, 0);
  const uint32_t left = run_fast(t, budget);
  return left == 0 ? RunResult{Stop::Budget, budget} : run_on(task, budget, budget - left);
}

RunResult Machine::run(int task, uint32_t budget) {
  assert(task >= 1 && task <= kTasks);
  return run_task(task, budget);
}

uint32_t Machine::run_tasks(const std::array<uint32_t, kTasks>& budgets) {
  uint32_t executed = 0;
  for (int task = 1; task <= kTasks; ++task)
    executed += run_task(task, budgets[static_cast<size_t>(task - 1)]).commands;
  return executed;
}

inline void Machine::BeforeAhead::Stand::note(const TaskContext& t) {
  pc = t.pc;
  depth = t.depth;
  commands = t.commands;
  std::copy_n(t.calls.begin(), depth, calls.begin());
}

inline void Machine::BeforeAhead::Stand::give_back(TaskContext& t) const {
  t.pc = pc;
  t.depth = depth;
  t.commands = commands;
  std::copy_n(calls.begin(), depth, t.calls.begin());
}

bool Machine::run_ahead(const std::array<uint32_t, kTasks>& budgets, uint32_t ticks,
                        std::span<const uint16_t> rollback) {
  BeforeAhead before;
  return run_ahead(budgets, ticks, rollback, before);
}

bool Machine::run_ahead(const std::array<uint32_t, kTasks>& budgets, uint32_t ticks,
                        std::span<const uint16_t> rollback, BeforeAhead& before) {
  if (fast_ == nullptr || events_ || watches_ || rollback.size() > kMostRollback) return false;
  if (waits_ && waits_on() < ticks) return false;
#ifndef __OPTIMIZE__  // the copy is too dear for a hot loop
  const std::array<int32_t, kMaxVariables> variables = h_;
#endif
  before.ticks = 0;
  for (size_t n = 0; n < rollback.size(); ++n) before.values[n] = h_[rollback[n]];
  for (size_t n = 0; n < kTasks; ++n) {
    TaskContext& t = contexts_[active_[n]];
    if (t.state != TaskState::Ready) continue;
    before.stands[n].note(t);
    if (run_fast(t, budgets[n] * ticks) == 0) continue;
    before.tasks = n + 1;
    take_back(rollback, before);
#ifndef __OPTIMIZE__
    assert(h_ == variables);
#endif
    return false;
  }
  before.tasks = kTasks;
  before.ticks = ticks;
  if (waits_)
    for (TaskContext& t : contexts_)
      if (t.state == TaskState::Waiting && t.wait_ms != 0) t.wait_ms -= ticks;
  return true;
}

void Machine::take_back(std::span<const uint16_t> rollback, const BeforeAhead& before) {
  for (size_t n = 0; n < before.tasks; ++n)
    if (TaskContext& t = contexts_[active_[n]]; t.state == TaskState::Ready) before.stands[n].give_back(t);
  for (size_t n = 0; n < rollback.size(); ++n) h_[rollback[n]] = before.values[n];
  if (waits_)
    for (TaskContext& t : contexts_)
      if (t.state == TaskState::Waiting && t.wait_ms != 0) t.wait_ms += before.ticks;
}

uint32_t Machine::waits_on() const {
  uint32_t ticks = UINT32_MAX;
  if (waits_)
    for (const TaskContext& t : contexts_)
      if (t.state == TaskState::Waiting && t.wait_ms != 0) ticks = std::min(ticks, t.wait_ms - 1);
  return ticks;
}

// From a command on that is the reference interpreter's, if there is one to be executed.
RunResult Machine::run_on(int task, uint32_t budget, uint32_t used) {
  for (;;) {
    const int number = active_context(task);
    TaskContext& t = context_at(number);
    if (t.state == TaskState::Waiting) return {Stop::Waiting, used};
    if (t.state == TaskState::Stopped) return {Stop::Ended, used};
    if (used == budget) return {Stop::Budget, used};
    ++used;
    ++t.commands;
    if (execute(number, t) == Stop::Faulted) return {Stop::Faulted, used};
    // It may have ended a routine: then what that interrupted goes on.
    TaskContext& next = context_at(active_context(task));
    if (next.state == TaskState::Ready) used = budget - run_fast(next, budget - used);
  }
}

void Machine::tick() {
  if (waits_) pass_millisecond();
  if (events_) take_events();
  if (watches_) {
    take_variable_interrupts();
  } else if (program_.limits().variables > kVarIntReq) {
    h_[kVarIntReq] &= ~kAllRequests;  // nobody is there to take them
  }
}

void Machine::pass_millisecond() {
  waits_ = false;
  for (TaskContext& t : contexts_) {
    if (t.state != TaskState::Waiting || t.wait_ms == 0) continue;
    if (--t.wait_ms == 0)
      go_on(t);
    else
      waits_ = true;
  }
}

void Machine::resume(int context) {
  assert(context >= 1 && context <= kContexts);
  TaskContext& t = context_at(context);
  if (t.state == TaskState::Waiting && t.wait_ms == 0) go_on(t);
}

void Machine::go_on(TaskContext& t) {
  assert(t.state == TaskState::Waiting && t.wait_ms == 0);
  t.state = TaskState::Ready;
  t.pc += decode(program_.code(), t.pc).words;
}

void Machine::raise_fault(uint8_t number, const char* reason) {
  int task = 1;
  for (int other = kTasks; other > 0; --other)
    if (context(other).state != TaskState::Stopped) task = other;
  raise(active_context(task), number, reason);
}

void Machine::raise(int number, uint8_t fault, const char* reason) {
  assert(fault != 0 && reason != nullptr);
  const TaskContext& t = context(number);
  fault_ = {fault, t.task, static_cast<uint8_t>(number), t.pc, reason};
  stop_all();
}

// Executes the command at t.pc. Stop::Budget means: go on.
Stop Machine::execute(int number, TaskContext& t) {
  const Decoded decoded = decode(program_.code(), t.pc);
  const Instruction& command = decoded.instruction;
  const int32_t a = command.operands[0];
  const int32_t b = command.operands[1];
  const auto ha = [&]() -> int32_t& { return h_[static_cast<size_t>(a)]; };
  const auto hb = [&]() -> int32_t& { return h_[static_cast<size_t>(b)]; };
  const auto is_variable = [&](int32_t h) { return bits(h) < program_.limits().variables; };
  const auto fail = [&](uint8_t fault, const char* reason) {
    raise(number, fault, reason);
    return Stop::Faulted;
  };
  const auto branch = [&](bool condition) {
    t.pc = condition ? bits(command.operands[2]) : t.pc + decoded.words;
    return Stop::Budget;
  };
  const auto call = [&](int32_t target) {
    if (t.depth == program_.limits().call_depth || t.depth == kMaxCallDepth)
      return fail(kFaultIndexOverflow, "calls are nested deeper than the unit allows");
    t.calls[t.depth++] = static_cast<uint16_t>(t.pc + decoded.words);
    t.pc = bits(target);
    return Stop::Budget;
  };
  static constexpr const char* kDivision = "division by zero";
  static constexpr const char* kNoVariable = "the unit has no variable with this number";

  switch (command.opcode) {
    case Opcode::Nop: break;
    case Opcode::End: stop_task(t.task); return Stop::Ended;
    case Opcode::Ret:
      if (t.depth == 0) {
        end(t);
        return Stop::Ended;
      }
      t.pc = t.calls[--t.depth];
      return Stop::Budget;
    case Opcode::Call: return call(a);

    case Opcode::Jmp: t.pc = bits(a); return Stop::Budget;
    case Opcode::JmpEqHH: return branch(ha() == hb());
    case Opcode::JmpNeHH: return branch(ha() != hb());
    case Opcode::JmpLtHH: return branch(ha() < hb());
    case Opcode::JmpLeHH: return branch(ha() <= hb());
    case Opcode::JmpGtHH: return branch(ha() > hb());
    case Opcode::JmpGeHH: return branch(ha() >= hb());
    case Opcode::JmpEqHK: return branch(ha() == b);
    case Opcode::JmpNeHK: return branch(ha() != b);
    case Opcode::JmpLtHK: return branch(ha() < b);
    case Opcode::JmpLeHK: return branch(ha() <= b);
    case Opcode::JmpGtHK: return branch(ha() > b);
    case Opcode::JmpGeHK: return branch(ha() >= b);

    case Opcode::SetHH: ha() = hb(); break;
    case Opcode::SetHK: ha() = b; break;
    case Opcode::SetiStore:
      if (!is_variable(ha())) return fail(kFaultIllop, kNoVariable);
      h_[bits(ha())] = hb();
      break;
    case Opcode::SetiLoad:
      if (!is_variable(hb())) return fail(kFaultIllop, kNoVariable);
      ha() = h_[bits(hb())];
      break;
    case Opcode::Copy: std::memmove(&ha(), &hb(), sizeof(int32_t) * bits(command.operands[2])); break;

    case Opcode::AddHH: ha() = add(ha(), hb()); break;
    case Opcode::SubHH: ha() = subtract(ha(), hb()); break;
    case Opcode::MulHH: ha() = multiply(ha(), hb()); break;
    case Opcode::DivHH:
      if (hb() == 0) return fail(kFaultIllop, kDivision);
      ha() = divide(ha(), hb());
      break;
    case Opcode::ModHH:
      if (hb() == 0) return fail(kFaultIllop, kDivision);
      ha() = remainder(ha(), hb());
      break;
    case Opcode::AndHH: ha() &= hb(); break;
    case Opcode::OrHH: ha() |= hb(); break;
    case Opcode::XorHH: ha() ^= hb(); break;
    case Opcode::ShlHH: ha() = shift_left(ha(), hb()); break;
    case Opcode::ShrHH: ha() = shift_right(ha(), hb()); break;
    case Opcode::AshrHH: ha() = shift_right_sign(ha(), hb()); break;
    case Opcode::NotH: ha() = ~hb(); break;
    case Opcode::AddHK: ha() = add(ha(), b); break;
    case Opcode::SubHK: ha() = subtract(ha(), b); break;
    case Opcode::MulHK: ha() = multiply(ha(), b); break;
    case Opcode::DivHK:
      if (b == 0) return fail(kFaultIllop, kDivision);
      ha() = divide(ha(), b);
      break;
    case Opcode::ModHK:
      if (b == 0) return fail(kFaultIllop, kDivision);
      ha() = remainder(ha(), b);
      break;
    case Opcode::AndHK: ha() &= b; break;
    case Opcode::OrHK: ha() |= b; break;
    case Opcode::XorHK: ha() ^= b; break;
    case Opcode::ShlHK: ha() = shift_left(ha(), b); break;
    case Opcode::ShrHK: ha() = shift_right(ha(), b); break;
    case Opcode::AshrHK: ha() = shift_right_sign(ha(), b); break;

    case Opcode::BitSet: ha() = set_bit(ha(), b, true); break;
    case Opcode::BitClear: ha() = set_bit(ha(), b, false); break;
    case Opcode::BitMove:
    case Opcode::BitMoveNeg: {
      const bool source = test_bit(h_[static_cast<size_t>(command.operands[2])], command.operands[3]);
      ha() = set_bit(ha(), b, source == (command.opcode == Opcode::BitMove));
      break;
    }

    case Opcode::WaitH:
    case Opcode::WaitK: {
      const int32_t ms = command.opcode == Opcode::WaitH ? ha() : a;
      if (ms <= 0) break;  // nothing to wait for (ours)
      t.wait_ms = bits(ms);
      t.state = TaskState::Waiting;
      waits_ = true;
      return Stop::Waiting;
    }

    case Opcode::Task2:
    case Opcode::Task: {
      const int other = command.opcode == Opcode::Task2 ? 2 : 3;
      if (a == 0)
        stop_task(other);
      else
        start_task(other, bits(b));
      if (t.state == TaskState::Stopped) return Stop::Ended;
      if (other == number) return Stop::Budget;  // it has restarted itself
      break;
    }
    case Opcode::SetInt: set_interrupt(a, bits(b)); break;
    case Opcode::VarInt:
      if (const char* reason = set_variable_interrupt(bits(a), bits(b))) return fail(kFaultIllop, reason);
      break;

    default: {  // everything else is the host's
      const HostReply reply =
          host_.execute == nullptr
              ? HostReply{Answer::Fault, kFaultIllop, "the unit cannot carry out system commands"}
              : host_.execute(host_.self, *this, number, command);
      if (reply.answer == Answer::Fault) return fail(reply.fault, reply.reason);
      if (t.state == TaskState::Stopped) return Stop::Ended;
      if (t.commands == 0) return Stop::Budget;  // the command has restarted its own task
      if (reply.answer == Answer::Wait) {
        t.state = TaskState::Waiting;
        return Stop::Waiting;
      }
      if (reply.answer == Answer::Taken) {
        const Coding& row = coding(command.opcode);
        return call(command.operands[row.operand_count - 1]);
      }
      break;
    }
  }
  t.pc += decoded.words;
  return Stop::Budget;
}

}  // namespace ipos::vm
