#include "tests/engines/pair.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "tests/generated/pcg.hpp"
#include "vm/exec/saved_state.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/jit/jit.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::tests {
namespace {

using vm::Machine;
using vm::TaskContext;
using vm::TaskState;

constexpr uint8_t kHostFault = 77;

// Keeps to vm/host/host.hpp. Its answers depend on the seed and on the commands alone.
struct RandomHost {
  Pcg random;

  static vm::HostReply execute(void* self, Machine& machine, int context,
                               const vm::Instruction& command) noexcept {
    Pcg& random = static_cast<RandomHost*>(self)->random;
    const auto variables = machine.variables();
    if (random.one_in(4))
      variables[static_cast<size_t>(random.below(static_cast<int>(variables.size())))] =
          static_cast<int32_t>(random.next());
    if (random.one_in(60)) machine.stop_task(1 + random.below(3));
    if (context <= vm::kTasks && random.one_in(60)) machine.start_task(context, 0);
    switch (random.below(10)) {
      case 0: return {vm::Answer::Wait, 0, nullptr};
      case 1:
      case 2:
      case 3:
        if (vm::info(command.opcode).flow == vm::Flow::SystemCall) return {vm::Answer::Taken, 0, nullptr};
        return {};
      case 4:
        if (random.one_in(20)) return {vm::Answer::Fault, kHostFault, "by chance"};
        return {};
      default: return {};
    }
  }
};

// What a machine keeps besides its state has to follow from it: the machine is written and read back, which
// makes that anew. The reason of a fault would not come back.
void forget(Machine& machine) {
  if (machine.fault().number != 0) return;
  std::vector<uint8_t> bytes(vm::SavedState::size(machine.program()));
  vm::SavedState::write(machine, bytes.data());
  vm::SavedState::read(bytes.data(), machine);
}

void start(Machine& machine) {
  machine.start();
  forget(machine);  // so that machines without a fault have equal reasons
}

std::string difference(const Machine& a, const Machine& b) {
  const auto ours = a.variables(), theirs = b.variables();
  assert(ours.size() == theirs.size());
  if (!std::equal(ours.begin(), ours.end(), theirs.begin())) {
    const auto [x, y] = std::mismatch(ours.begin(), ours.end(), theirs.begin());
    return "H" + std::to_string(x - ours.begin()) + ": " + std::to_string(*x) + " and " + std::to_string(*y);
  }
  for (int number = 1; number <= vm::kContexts; ++number) {
    const TaskContext &x = a.context(number), &y = b.context(number);
    const std::string name = vm::context_name(number);
    if (x.pc != y.pc) return name + ": pc " + std::to_string(x.pc) + " and " + std::to_string(y.pc);
    if (x.commands != y.commands)
      return name + ": " + std::to_string(x.commands) + " and " + std::to_string(y.commands) + " commands";
    if (x.state != y.state || x.depth != y.depth || x.task != y.task || x.rank != y.rank ||
        x.wait_ms != y.wait_ms || !std::equal(x.calls.begin(), x.calls.begin() + x.depth, y.calls.begin()))
      return name + ": state, calls or wait";
  }
  for (int task = 1; task <= vm::kTasks; ++task)
    if (a.active_context(task) != b.active_context(task)) return "what executes of a task";
  const vm::Fault &f = a.fault(), &g = b.fault();
  if (f.number != g.number || f.task != g.task || f.context != g.context || f.address != g.address ||
      f.reason != g.reason)
    return "fault F" + std::to_string(f.number) + " and F" + std::to_string(g.number);
  for (size_t n = 0; n < a.interrupts().events.size(); ++n)
    if (a.interrupts().events[n].pending != b.interrupts().events[n].pending) return "a pending event";
  return "";
}

uint32_t random_budget(Pcg& random) {
  switch (random.below(6)) {
    case 0: return 1;
    case 1: return static_cast<uint32_t>(1 + random.below(4));
    case 2:
    case 3: return static_cast<uint32_t>(1 + random.below(40));
    case 4: return static_cast<uint32_t>(1 + random.below(400));
    default: return static_cast<uint32_t>(1 + random.below(4000));
  }
}

std::vector<uint32_t> starts_of(std::span<const uint32_t> code) {
  std::vector<uint32_t> starts;
  for (uint32_t at = 0; at < code.size(); at += vm::decode(code, at).words) starts.push_back(at);
  return starts;
}

void append(std::vector<uint32_t>& code, const vm::Instruction& command) {
  std::array<uint32_t, vm::kMaxWords> words{};
  const uint32_t length = vm::encode(command, words);
  code.insert(code.end(), words.begin(), words.begin() + length);
}

size_t label_of(const vm::OpcodeInfo& row) {
  for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n)
    if (row.operands[n].kind == vm::OperandKind::Label) return n;
  return vm::kMaxOperands;
}

}  // namespace

PairRun run_pair(const vm::VerifiedImage& program, uint64_t seed, uint32_t orders) {
  PairRun out;
  std::vector<vm::fast::Slot> slots(vm::fast::Predecoded::slots_needed(program.code().size()));
  const vm::fast::Predecoded predecoded(program, slots);
  const std::vector<uint32_t> starts = starts_of(program.code());
  const auto code = vm::jit::compile(program);
  RandomHost hosts[] = {{Pcg(seed)}, {Pcg(seed)}, {Pcg(seed)}};
  std::vector<Machine> machines;
  for (RandomHost& host : hosts) machines.push_back(Machine(program, {&host, RandomHost::execute}));
  machines[1].use(&predecoded);
  machines[2].use(&predecoded, code == nullptr ? nullptr : &code->native());
  out.native = code != nullptr;
  if (!out.native) machines.pop_back();
  constexpr const char* kEngines[] = {"", "fast engine", "machine code"};
  Pcg random(seed ^ 0x5EED);
  for (Machine& machine : machines) start(machine);
  for (; out.orders < orders; ++out.orders) {
    // The order is drawn once, then given to both.
    const int kind = random.below(12);
    const int task = 1 + random.below(3);
    const uint32_t budget = random_budget(random);
    const uint32_t address = starts[static_cast<size_t>(random.below(static_cast<int>(starts.size())))];
    const int32_t value = random.one_in(2) ? random.below(40) : static_cast<int32_t>(random.next());
    const auto variable = static_cast<size_t>(random.below(static_cast<int>(program.limits().variables)));
    const int context = 1 + random.below(vm::kContexts);
    forget(machines[0]);
    std::array<vm::RunResult, 3> results{};
    for (size_t n = 0; n < machines.size(); ++n) {
      Machine& machine = machines[n];
      if (kind < 6) {
        results[n] = machine.run(kind < 4 ? 1 : task, budget);
      } else if (kind == 6) {
        machine.raise_event(static_cast<vm::Event>(task - 1));
      } else if (kind == 7 && machine.task(task).state == TaskState::Stopped && machine.fault().number == 0) {
        machine.start_task(task, address);
      } else if (kind == 8) {
        machine.variables()[variable] = value;
      } else if (kind == 9) {
        for (int at = 1; at <= vm::kContexts; ++at)
          if (at != context) machine.resume(at);
      } else {
        machine.tick();
      }
    }
    out.commands += results[0].commands;
    for (size_t n = 1; n < machines.size() && out.difference.empty(); ++n) {
      out.difference = difference(machines[0], machines[n]);
      if (out.difference.empty() &&
          (results[0].stop != results[n].stop || results[0].commands != results[n].commands))
        out.difference = "run executed " + std::to_string(results[0].commands) + " and " +
                         std::to_string(results[n].commands) + " commands";
      if (!out.difference.empty()) out.difference = std::string(kEngines[n]) + ": " + out.difference;
    }
    if (!out.difference.empty()) {
      out.difference += " (seed " + std::to_string(seed) + ", order " + std::to_string(out.orders) + ")";
      return out;
    }
    if (machines[0].fault().number != 0) {
      if (random.one_in(3)) return out;
      for (Machine& machine : machines) start(machine);
    }
  }
  return out;
}

std::string run_idle_pair(const vm::VerifiedImage& program, uint64_t seed, uint32_t orders, uint64_t& skipped,
                          uint64_t& all) {
  std::vector<vm::fast::Slot> slots(vm::fast::Predecoded::slots_needed(program.code().size()));
  const vm::fast::Predecoded predecoded(program, slots);
  RandomHost hosts[] = {{Pcg(seed)}, {Pcg(seed)}};
  Machine a(program, {&hosts[0], RandomHost::execute});
  Machine b(program, {&hosts[1], RandomHost::execute});
  const auto code = vm::jit::compile(program);
  b.use(&predecoded, code == nullptr ? nullptr : &code->native());
  Pcg random(seed ^ 0x1D1E);
  const auto budget = [&](int most) { return static_cast<uint32_t>(1 + random.below(most)); };
  const vm::Rates rates{{budget(10), budget(10), budget(40)}};
  start(a);
  start(b);
  for (uint32_t order = 0; order < orders; ++order) {
    const auto variable = static_cast<size_t>(random.one_in(2) ? 300 + random.below(12) : random.below(1024));
    const int32_t value = random.below(8);
    const int kind = random.below(5);
    const auto ticks = static_cast<uint64_t>(1 + random.below(100));
    uint64_t executed_a = 0, executed_b = 0;
    for (Machine* machine : {&a, &b}) {
      if (kind == 0) machine->variables()[variable] = value;
      if (kind == 1) machine->raise_event(static_cast<vm::Event>(value % vm::kEvents));
      if (kind == 2)
        for (int number = 1; number <= vm::kContexts; ++number) machine->resume(number);
    }
    forget(a);
    for (uint64_t n = 0; n < ticks; ++n) executed_a += vm::run_tick(a, rates);
    for (uint64_t n = 0; n < ticks;) {
      const uint64_t idle = skip_idle(b, rates, ticks - n, executed_b);
      skipped += idle;
      n += idle;
      if (idle == 0) executed_b += vm::run_tick(b, rates), ++n;
    }
    all += ticks;
    std::string found = difference(a, b);
    if (found.empty() && executed_a != executed_b) found = "the number of commands executed";
    if (found.empty() && a.interrupts().turn != b.interrupts().turn) found = "the turn of the interrupts";
    if (!found.empty())
      return found + " (seed " + std::to_string(seed) + ", order " + std::to_string(order) + ")";
  }
  return "";
}

std::vector<uint32_t> with_interrupts(const std::vector<uint32_t>& code, const vm::Limits& limits,
                                      uint64_t seed) {
  Pcg random(seed);
  const std::vector<uint32_t> starts = starts_of(code);
  const auto address = [&] {
    return static_cast<int32_t>(starts[static_cast<size_t>(random.below(static_cast<int>(starts.size())))]);
  };
  std::vector<vm::Instruction> commands;
  for (int32_t event = 1; event <= 3; ++event)
    if (random.one_in(2)) commands.push_back({vm::Opcode::SetInt, {event, address()}});
  if (limits.tasks == vm::kTasks) {
    const int32_t first = limits.variables - 10;
    const int32_t values[] = {1 + random.below(2), random.below(4),  random.below(limits.variables),
                              random.below(20),    random.below(10), 1 + random.below(10)};
    for (int32_t n = 0; n < 6; ++n) commands.push_back({vm::Opcode::SetHK, {first + n, values[n]}});
    commands.push_back({vm::Opcode::VarInt, {first, address()}});
  }
  uint32_t length = 0;
  for (const vm::Instruction& command : commands)
    length += static_cast<uint32_t>(vm::info(command.opcode).words);
  for (const uint32_t at : starts) commands.push_back(vm::decode(code, at).instruction);
  std::vector<uint32_t> out;
  for (size_t n = 0; n < commands.size(); ++n) {
    const size_t label = label_of(vm::info(commands[n].opcode));
    if (label < vm::kMaxOperands) commands[n].operands[label] += static_cast<int32_t>(length);
    append(out, commands[n]);
  }
  return out.size() <= limits.program_words ? out : std::vector<uint32_t>{};
}

std::vector<uint32_t> assembled(std::vector<vm::Instruction> commands) {
  std::vector<int32_t> addresses;
  int32_t next = 0;
  for (const vm::Instruction& command : commands) {
    addresses.push_back(next);
    next += vm::info(command.opcode).words;
  }
  std::vector<uint32_t> code;
  for (vm::Instruction& command : commands) {
    const size_t label = label_of(vm::info(command.opcode));
    if (label < vm::kMaxOperands)
      command.operands[label] = addresses[static_cast<size_t>(command.operands[label])];
    append(code, command);
  }
  return code;
}

std::vector<uint32_t> sequence_soup(uint64_t seed) {
  Pcg random(seed);
  constexpr int kVariables = 6;
  std::vector<vm::Instruction> commands;
  const auto variable = [&] { return random.below(kVariables); };
  // A temporary that is set and then used is what most sequences need to meet as their rows say.
  const auto add = [&](vm::Opcode opcode, int32_t result) {
    vm::Instruction command{opcode, {}};
    const vm::OpcodeInfo& row = vm::info(opcode);
    for (size_t n = 0; n < static_cast<size_t>(row.operand_count); ++n) {
      int32_t& operand = command.operands[n];
      switch (row.operands[n].kind) {
        case vm::OperandKind::Variable: operand = random.one_in(2) ? result : variable(); break;
        case vm::OperandKind::Constant:
          operand = random.one_in(8) ? static_cast<int32_t>(random.next()) : random.below(12) - 2;
          break;
        case vm::OperandKind::Bit: operand = random.below(32); break;
        case vm::OperandKind::Count: operand = 1 + random.below(8); break;
        case vm::OperandKind::Keyword: operand = 1; break;
        default: break;
      }
    }
    commands.push_back(command);
  };
  const int groups = 4 + random.below(24);
  for (int group = 0; group < groups; ++group) {
    const auto first = static_cast<int32_t>(commands.size());
    const int32_t result = variable();
    if (random.one_in(8)) {  // a switch
      if (random.one_in(2)) add(vm::Opcode::SetHH, result);
      int32_t constant = random.below(3);
      for (int n = 2 + random.below(6); n > 0; --n) {
        commands.push_back({vm::Opcode::JmpEqHK, {result, constant, 0}});
        constant += random.one_in(5) ? random.below(7) - 3 : 1;
      }
      continue;
    }
    const auto operation =
        static_cast<vm::fast::Operation>(random.below(static_cast<int>(vm::fast::Operation::kCount)));
    for (const vm::Opcode opcode : vm::fast::commands_of(operation)) add(opcode, result);
    if (random.one_in(20)) commands.push_back({vm::Opcode::Nop, {}});
    if (random.one_in(20)) add(vm::Opcode::Movlnk, result);
    if (random.one_in(20)) commands.push_back({vm::Opcode::WaitK, {random.below(3)}});
    // Loops over one sequence, now and then.
    if (!commands.empty() && random.one_in(3)) {
      vm::Instruction& last = commands.back();
      const size_t label = label_of(vm::info(last.opcode));
      if (label < vm::kMaxOperands) last.operands[label] = ~first;
    }
  }
  commands.push_back({random.one_in(2) ? vm::Opcode::End : vm::Opcode::Ret, {}});
  for (vm::Instruction& command : commands) {
    const size_t label = label_of(vm::info(command.opcode));
    if (label == vm::kMaxOperands) continue;
    int32_t& operand = command.operands[label];
    operand = operand < 0 ? ~operand : random.below(static_cast<int>(commands.size()));
  }
  return assembled(commands);
}

std::vector<uint32_t> table_loops(uint64_t seed, const vm::Limits& limits) {
  Pcg random(seed);
  using vm::Opcode;
  // Eight variables for all, in a row somewhere, so that they divide the others into two tables; and others
  // for temporaries now and then, as they would be where there are too many for registers.
  const int most = limits.variables - 1;
  const int base = random.one_in(2) ? random.below(4) : random.below(most - 8);
  const int32_t counter = base, step = base + 1, limit = base + 2, value = base + 3;
  std::vector<vm::Instruction> commands;
  const auto put = [&](Opcode opcode, int32_t a = 0, int32_t b = 0, int32_t c = 0) {
    commands.push_back({opcode, {a, b, c}});
  };
  const auto near = [&](int number) { return number + random.below(7) - 3; };
  const auto edge = [&] {
    const int edges[] = {0, base, base + 8, limits.variables, random.below(limits.variables)};
    return random.one_in(30) ? static_cast<int32_t>(random.next()) : near(edges[random.below(5)]);
  };
  const int loops = 1 + random.below(3);
  for (int loop = 0; loop < loops; ++loop) {
    const int32_t constant = random.one_in(3) ? 0 : near(random.below(limits.variables));
    const int32_t by = random.one_in(6)    ? edge()
                       : random.one_in(20) ? std::numeric_limits<int32_t>::max() - random.below(80)
                                           : 1 + random.below(5);
    put(Opcode::SetHK, counter, edge() - constant);
    put(Opcode::SetHK, step, by);
    put(Opcode::SetHK, limit, edge() - constant);
    const auto first = static_cast<int32_t>(commands.size());
    for (int access = 1 + random.below(3); access > 0; --access) {
      int32_t index = counter;
      if (!random.one_in(4)) {
        index = random.one_in(3) ? random.below(limits.variables) : base + 4 + random.below(2);
        const int32_t added = near(constant);
        put(Opcode::SetHH, index, random.one_in(20) ? value : counter);
        if (random.one_in(5))
          put(Opcode::SubHK, index, -added);
        else
          put(Opcode::AddHK, index, added);
        if (random.one_in(20)) put(Opcode::MulHK, index, 2);
      }
      if (random.one_in(4)) put(Opcode::SetiStore, counter, value);
      if (random.one_in(3)) put(Opcode::SetHK, value, near(0));
      if (random.one_in(2)) {
        put(Opcode::SetiStore, index, value);
      } else {
        put(Opcode::SetiLoad, base + 6, index);
        put(Opcode::AddHH, base + 7, base + 6);
        if (random.one_in(4)) put(random.one_in(2) ? Opcode::SubHH : Opcode::AddHH, base + 7, value);
      }
      // What makes the loop another.
      if (random.one_in(12)) put(Opcode::AddHK, base + random.below(3), random.below(12));
      if (random.one_in(16)) put(Opcode::DivHH, base + random.below(8), base + random.below(8));
    }
    if (random.one_in(2))
      put(Opcode::AddHK, counter, by);
    else
      put(Opcode::AddHH, counter, step);
    const Opcode tests_k[] = {Opcode::JmpLtHK, Opcode::JmpLeHK, Opcode::JmpNeHK};
    const Opcode tests_h[] = {Opcode::JmpLtHH, Opcode::JmpLeHH, Opcode::JmpGeHH};
    const int which = random.one_in(10) ? 2 : random.below(2);
    if (random.one_in(2))
      put(tests_k[which], counter, edge() - constant, first);
    else
      put(tests_h[which], counter, limit, first);
    if (random.one_in(4))
      put(Opcode::JmpEqHK, value, near(0), random.below(static_cast<int>(commands.size())));
  }
  put(random.one_in(8) ? Opcode::End : Opcode::Jmp);
  return assembled(commands);
}

std::vector<uint32_t> state_machine(uint64_t seed) {
  Pcg random(seed);
  using vm::Opcode;
  constexpr int32_t kState = 1, kSeen = 2, kCount = 3, kOther = 4;
  std::vector<vm::Instruction> commands;
  std::vector<size_t> to_end;
  const auto put = [&](Opcode opcode, int32_t a = 0, int32_t b = 0, int32_t c = 0) {
    commands.push_back({opcode, {a, b, c}});
  };
  const int states = 2 + random.below(6);
  const auto any_state = [&] { return random.below(states + 1) - (random.one_in(10) ? 1 : 0); };
  put(Opcode::SetHK, kState, any_state());
  const auto head = static_cast<int32_t>(commands.size());
  if (random.one_in(6)) put(Opcode::AddHK, kCount, 1);
  const bool copied = !random.one_in(3);
  if (copied) put(Opcode::SetHH, kSeen, kState);
  if (random.one_in(6)) put(Opcode::SetHH, kOther, random.one_in(2) ? kSeen : kState);
  const size_t tests = commands.size();
  for (int state = 0; state < states; ++state) {
    const int32_t of = random.one_in(12) ? kOther : copied ? kSeen : kState;
    put(random.one_in(8) ? Opcode::JmpNeHK : Opcode::JmpEqHK, of, random.one_in(10) ? any_state() : state);
  }
  if (random.one_in(2)) put(Opcode::AddHK, kOther, 1);
  to_end.push_back(commands.size());
  put(Opcode::Jmp);
  for (int state = 0; state < states; ++state) {
    const size_t test = tests + static_cast<size_t>(state);
    commands[test].operands[2] = random.one_in(20) ? random.below(static_cast<int>(commands.size()))
                                                   : static_cast<int32_t>(commands.size());
    if (random.one_in(2)) put(Opcode::AddHH, kOther, kCount);
    if (random.one_in(3)) {  // one of two
      const auto at = static_cast<int32_t>(commands.size());
      put(Opcode::JmpLtHK, kOther, random.below(9) - 4, at + 3);
      put(Opcode::SetHK, kState, any_state());
      to_end.push_back(commands.size());
      put(Opcode::Jmp);
    }
    if (!random.one_in(8)) put(Opcode::SetHK, random.one_in(8) ? kOther : kState, any_state());
    if (random.one_in(8)) put(Opcode::Nop);
    if (state + 1 == states && random.one_in(2)) break;
    to_end.push_back(commands.size());
    put(Opcode::Jmp);
  }
  const auto end = static_cast<int32_t>(commands.size());
  for (const size_t jump : to_end) commands[jump].operands[0] = random.one_in(5) ? head : end;
  if (random.one_in(6)) put(Opcode::AddHK, random.one_in(2) ? kState : kOther, 1);
  if (random.one_in(2)) {
    put(Opcode::AddHK, kCount, 1);
    put(random.one_in(4) ? Opcode::JmpNeHK : Opcode::JmpLtHK, kCount, 5 + random.below(40), head);
    put(Opcode::SetHK, kCount, 0);
  }
  put(random.one_in(8) ? Opcode::End : Opcode::Jmp, random.one_in(2) ? head : 0);
  return assembled(commands);
}

}  // namespace ipos::tests
