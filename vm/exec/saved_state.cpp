// What is saved of a machine stands once, in the visit() functions.
#include "vm/exec/saved_state.hpp"

#include <bitset>

#include "vm/exec/saved_bytes.hpp"

namespace ipos::vm {
namespace {

template <class Bytes, class T>
constexpr void visit_context(Bytes& bytes, T& t) {
  bytes(t.state), bytes(t.depth), bytes(t.task), bytes(t.rank);
  bytes(t.pc), bytes(t.wait_ms), bytes(t.commands);
  for (auto& address : t.calls) bytes(address);
}

template <class Bytes, class T>
constexpr void visit_interrupts(Bytes& bytes, T& interrupts) {
  for (auto& row : interrupts.events) bytes(row.installed), bytes(row.pending), bytes(row.address);
  for (auto& row : interrupts.variables) {
    bytes(row.installed), bytes(row.held), bytes(row.mode), bytes(row.task), bytes(row.priority);
    bytes(row.source), bytes(row.structure), bytes(row.compare), bytes(row.last), bytes(row.address);
  }
  bytes(interrupts.turn);
}

template <class Bytes, class T>
constexpr void visit_fault(Bytes& bytes, T& fault) {
  bytes(fault.number), bytes(fault.task), bytes(fault.context), bytes(fault.address);
}

constexpr size_t kFixedSize = [] {
  ByteCounter counter;
  const TaskContext context;
  const Interrupts interrupts;
  const Fault fault;
  for (int n = 0; n < kContexts; ++n) visit_context(counter, context);
  visit_interrupts(counter, interrupts);
  visit_fault(counter, fault);
  return counter.size();
}();

class Check {
 public:
  explicit Check(const VerifiedImage& program) : program_(program) {
    const auto code = program.code();
    for (uint32_t at = 0; at < code.size(); at += decode(code, at).words) starts_[at] = true;
  }

  bool context(const TaskContext& t, int number) const {
    if (t.state > TaskState::Waiting || t.depth > program_.limits().call_depth || t.depth > kMaxCallDepth ||
        t.task > kTasks || t.rank > kMaxPriority)
      return false;
    for (size_t n = 0; n < t.depth; ++n)
      if (!starts(t.calls[n])) return false;
    if (number <= kTasks && (t.rank != 0 || (t.task != 0 && t.task != number))) return false;
    if (t.state == TaskState::Stopped) return true;
    if (t.task == 0 || t.commands > UINT64_MAX / 2 || !starts(t.pc)) return false;
    if (t.state == TaskState::Ready) return true;
    // Only a command that waits has one after it to go on with.
    const Opcode opcode = decode(program_.code(), t.pc).instruction.opcode;
    const Flow flow = coding(opcode).flow;
    const bool waits_for_time = opcode == Opcode::WaitH || opcode == Opcode::WaitK;
    return t.wait_ms != 0 ? waits_for_time
                          : !waits_for_time && (flow == Flow::System || flow == Flow::SystemCall);
  }

  bool interrupts(const Interrupts& all) const {
    for (const EventInterrupt& row : all.events)
      if (row.installed ? !starts(row.address) : row.pending) return false;
    const uint32_t variables = program_.limits().variables;
    for (const VariableInterrupt& row : all.variables) {
      if (!row.installed) continue;
      if (!starts(row.address) || static_cast<int32_t>(row.mode) >= kCompareModes || row.task < 2 ||
          row.task > kTasks || row.priority > kMaxPriority || row.source >= variables ||
          row.structure + 7U > variables)
        return false;
    }
    return true;
  }

 private:
  bool starts(uint32_t address) const { return address < program_.code().size() && starts_[address]; }

  const VerifiedImage& program_;
  std::bitset<kMaxProgramWords> starts_;
};

}  // namespace

size_t SavedState::size(const VerifiedImage& program) {
  return kFixedSize + sizeof(int32_t) * program.limits().variables;
}

uint8_t* SavedState::write(const Machine& machine, uint8_t* bytes) {
  ByteWriter out(bytes);
  for (const TaskContext& context : machine.contexts_) visit_context(out, context);
  visit_interrupts(out, machine.interrupts_);
  visit_fault(out, machine.fault_);
  for (const int32_t value : machine.variables()) out(value);
  return out.at();
}

bool SavedState::check(const VerifiedImage& program, const uint8_t* bytes) {
  const Check check(program);
  ByteReader in(bytes);
  for (int number = 1; number <= kContexts; ++number) {
    TaskContext context;
    visit_context(in, context);
    if (!check.context(context, number)) return false;
  }
  Interrupts interrupts;
  visit_interrupts(in, interrupts);
  Fault fault;
  visit_fault(in, fault);
  return in.ok() && check.interrupts(interrupts) && fault.task <= kTasks && fault.context <= kContexts;
}

const uint8_t* SavedState::read(const uint8_t* bytes, Machine& machine) {
  ByteReader in(bytes);
  for (TaskContext& context : machine.contexts_) visit_context(in, context);
  visit_interrupts(in, machine.interrupts_);
  visit_fault(in, machine.fault_);
  machine.fault_.reason = "";
  for (int32_t& value : machine.variables()) in(value);
  for (int task = 1; task <= kTasks; ++task) machine.choose_active(task);
  machine.see_interrupts();
  machine.waits_ = true;
  ++machine.begun_;
  return in.at();
}

void SavedState::go_on_at(Machine& machine, int context, uint32_t address) {
  machine.context_at(context).pc = address;
  ++machine.begun_;
}

}  // namespace ipos::vm
