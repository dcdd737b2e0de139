// Making machines and running them; their variables and tasks.
#include <algorithm>
#include <new>

#include "embed/objects.hpp"

namespace ipos::api {
namespace {

constexpr uint64_t kTickUs = 1000;
constexpr uint32_t kDefaultBaud = 500'000;

bool any_task_runs(const vm::Machine& machine) {
  for (int task = 1; task <= vm::kTasks; ++task)
    if (machine.task(task).state != vm::TaskState::Stopped) return true;
  return false;
}

// With a trace: command by command, each announced.
uint32_t run_traced(ipos_vm& self, int task, uint32_t budget) {
  uint32_t used = 0;
  while (used < budget) {
    const int active = self.machine.active_context(task);
    const vm::TaskContext& context = self.machine.context(active);
    if (context.state != vm::TaskState::Ready) break;
    const ipos_step step{self.ticks, context.pc, self.program->verified.code()[context.pc],
                         static_cast<uint8_t>(active)};
    self.host.trace(self.host.user, &self, &step);
    const vm::RunResult result = self.machine.run(task, 1);
    used += result.commands;
    if (result.stop != vm::Stop::Budget) break;
  }
  return used;
}

uint32_t run_task(ipos_vm& self, int task, uint32_t budget) {
  return self.host.trace != nullptr ? run_traced(self, task, budget)
                                    : self.machine.run(task, budget).commands;
}

uint64_t run_tick(ipos_vm& self) {
  self.machine.tick();
  uint64_t executed = 0;
  for (int task = 1; task <= vm::kTasks; ++task)
    executed += run_task(self, task, self.rates.commands[static_cast<size_t>(task - 1)]);
  const auto send = [&](uint32_t tag, const runtime::Frame& frame) {
    ipos_frame out{static_cast<uint16_t>(frame.id), frame.length, {}};
    std::copy(frame.data.begin(), frame.data.end(), out.data);
    self.host.send(self.host.user, &self, &out, tag);  // a failed one comes again with its next cycle
  };
  if (self.machine.fault().number == 0)
    self.objects.due(static_cast<int64_t>(self.ticks), self.machine.variables(), send);
  ++self.ticks;
  return executed;
}

bool is_task(uint8_t task) { return task >= 1 && task <= vm::kTasks; }
bool is_context(uint8_t context) { return context >= 1 && context <= vm::kContexts; }

}  // namespace
}  // namespace ipos::api

using namespace ipos;       // NOLINT
using namespace ipos::api;  // NOLINT

ipos_vm::ipos_vm(const ipos_program& loaded, const ipos_host& callbacks)
    : machine(loaded.verified, machine_host(*this)),
      program(&loaded),
      host(callbacks),
      objects(*loaded.unit, kDefaultBaud, 1) {
#if IPOS_FAST
  if (loaded.fast) machine.use(&*loaded.fast);
#endif
}

size_t ipos_vm_size(void) { return sizeof(ipos_vm); }

ipos_status ipos_init(void* memory, size_t size, const ipos_program* program, const ipos_host* host,
                      ipos_vm** out) {
  if (program == nullptr || out == nullptr) return IPOS_INVALID_ARGUMENT;
  const ipos_status status = check_memory(memory, size, sizeof(ipos_vm), alignof(ipos_vm));
  if (status == IPOS_OK) *out = new (memory) ipos_vm(*program, host != nullptr ? *host : ipos_host{});
  return status;
}

const ipos_program* ipos_program_of(const ipos_vm* vm) { return vm != nullptr ? vm->program : nullptr; }

ipos_status ipos_start(ipos_vm* vm) {
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  const Busy busy(*vm);
  vm->machine.start();
  vm->objects.stop();
  vm->fault_told = false;
  vm->due_known = false;
  return IPOS_OK;
}

ipos_status ipos_stop(ipos_vm* vm) {
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  const Busy busy(*vm);
  vm->machine.stop_all();
  vm->objects.stop();
  return IPOS_OK;
}

ipos_status ipos_set_rates(ipos_vm* vm, const uint32_t commands[3]) {
  if (vm == nullptr || commands == nullptr) return IPOS_INVALID_ARGUMENT;
  for (size_t n = 0; n < vm->rates.commands.size(); ++n) vm->rates.commands[n] = commands[n];
  return IPOS_OK;
}

ipos_status ipos_set_sbus(ipos_vm* vm, uint32_t baud, uint8_t address, uint8_t group, uint16_t sync_id) {
  constexpr uint32_t kMostBaud = 1'000'000;
  if (vm == nullptr || baud == 0 || baud > kMostBaud || address >= runtime::kSbusAddresses ||
      group >= runtime::kSbusAddresses || sync_id >= runtime::kStandardIdLimit)
    return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  const bool synchronous = vm->program->unit->has(stdlib::Trait::SynchronousSbus);
  vm->objects = runtime::ObjectTable(*vm->program->unit, baud, 1);
  vm->objects.set_profile({address, group, sync_id, false, synchronous, true});
  return IPOS_OK;
}

ipos_status ipos_run_ticks(ipos_vm* vm, uint32_t ticks, ipos_progress* progress) {
  ipos_progress ours{};
  if (progress == nullptr) progress = &ours;
  *progress = {};
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  if (vm->machine.fault().number != 0) return IPOS_FAULTED;
  const Busy busy(*vm);
  while (progress->ticks < ticks) {
    progress->commands += run_tick(*vm);
    ++progress->ticks;
    tell_fault(*vm);
    if (vm->machine.fault().number != 0) return IPOS_FAULTED;
  }
  return any_task_runs(vm->machine) ? IPOS_OK : IPOS_ENDED;
}

ipos_status ipos_run_commands(ipos_vm* vm, uint8_t task, uint32_t commands, uint32_t* done) {
  uint32_t ours = 0;
  if (done == nullptr) done = &ours;
  *done = 0;
  if (vm == nullptr || !is_task(task)) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  if (vm->machine.fault().number != 0) return IPOS_FAULTED;
  const Busy busy(*vm);
  *done = run_task(*vm, task, commands);
  tell_fault(*vm);
  if (vm->machine.fault().number != 0) return IPOS_FAULTED;
  return vm->machine.task(task).state == vm::TaskState::Stopped ? IPOS_ENDED : IPOS_OK;
}

ipos_status ipos_run_due(ipos_vm* vm, uint32_t most, ipos_progress* progress) {
  ipos_progress ours{};
  if (progress == nullptr) progress = &ours;
  *progress = {};
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->host.time_us == nullptr) return IPOS_NO_CALLBACK;
  if (vm->busy) return IPOS_BUSY;
  vm->busy = true;
  const uint64_t now = vm->host.time_us(vm->host.user);
  vm->busy = false;
  if (!vm->due_known) vm->due_us = now;
  vm->due_known = true;
  const uint64_t due = now >= vm->due_us ? (now - vm->due_us) / kTickUs : 0;
  const ipos_status status = ipos_run_ticks(vm, due < most ? static_cast<uint32_t>(due) : most, progress);
  vm->due_us += progress->ticks * kTickUs;
  return status;
}

uint64_t ipos_ticks(const ipos_vm* vm) { return vm != nullptr ? vm->ticks : 0; }

ipos_status ipos_read(const ipos_vm* vm, uint32_t variable, int32_t* value) {
  if (vm == nullptr || value == nullptr) return IPOS_INVALID_ARGUMENT;
  if (variable >= vm->machine.variables().size()) return IPOS_NO_VARIABLE;
  *value = vm->machine.variables()[variable];
  return IPOS_OK;
}

ipos_status ipos_write(ipos_vm* vm, uint32_t variable, int32_t value) {
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  if (variable >= vm->machine.variables().size()) return IPOS_NO_VARIABLE;
  vm->machine.variables()[variable] = value;
  return IPOS_OK;
}

ipos_status ipos_read_symbol(const ipos_vm* vm, const char* name, int32_t* value) {
  ipos_symbol symbol;
  const ipos_status status = ipos_find(ipos_program_of(vm), name, &symbol);
  return status == IPOS_OK ? ipos_read(vm, symbol.variable, value) : status;
}

ipos_status ipos_write_symbol(ipos_vm* vm, const char* name, int32_t value) {
  ipos_symbol symbol;
  const ipos_status status = ipos_find(ipos_program_of(vm), name, &symbol);
  return status == IPOS_OK ? ipos_write(vm, symbol.variable, value) : status;
}

int32_t* ipos_variables(ipos_vm* vm) { return vm != nullptr ? vm->machine.variables().data() : nullptr; }

ipos_status ipos_task_of(const ipos_vm* vm, uint8_t context, ipos_task* task) {
  if (vm == nullptr || task == nullptr || !is_context(context)) return IPOS_INVALID_ARGUMENT;
  const vm::TaskContext& t = vm->machine.context(context);
  *task = {static_cast<int32_t>(t.state), t.pc, t.wait_ms, t.depth, t.commands};
  return IPOS_OK;
}

ipos_status ipos_start_task(ipos_vm* vm, uint8_t task, uint32_t address) {
  if (vm == nullptr || !is_task(task) || task > vm->program->unit->tasks) return IPOS_INVALID_ARGUMENT;
  const auto code = vm->program->verified.code();
  uint32_t at = 0;
  while (at < address && at < code.size()) at += vm::decode(code, at).words;
  if (at != address || at >= code.size()) return IPOS_INVALID_ARGUMENT;
  const Busy busy(*vm);
  vm->machine.start_task(task, address);
  return IPOS_OK;
}

ipos_status ipos_stop_task(ipos_vm* vm, uint8_t task) {
  if (vm == nullptr || !is_task(task)) return IPOS_INVALID_ARGUMENT;
  const Busy busy(*vm);
  vm->machine.stop_task(task);
  return IPOS_OK;
}

ipos_status ipos_resume(ipos_vm* vm, uint8_t context) {
  if (vm == nullptr || !is_context(context)) return IPOS_INVALID_ARGUMENT;
  const vm::TaskContext& t = vm->machine.context(context);
  if (t.state != vm::TaskState::Waiting || t.wait_ms != 0) return IPOS_NOT_TAKEN;
  vm->machine.resume(context);
  return IPOS_OK;
}

ipos_status ipos_raise_event(ipos_vm* vm, ipos_event event) {
  if (vm == nullptr || event < 0 || event >= vm::kEvents) return IPOS_INVALID_ARGUMENT;
  vm->machine.raise_event(static_cast<vm::Event>(event));
  return IPOS_OK;
}

ipos_status ipos_fault_of(const ipos_vm* vm, ipos_fault* fault) {
  if (vm == nullptr || fault == nullptr) return IPOS_INVALID_ARGUMENT;
  const vm::Fault& f = vm->machine.fault();
  *fault = {f.number, f.task, f.context, f.address, f.reason != nullptr ? f.reason : ""};
  return IPOS_OK;
}

ipos_status ipos_raise_fault(ipos_vm* vm, uint8_t number, const char* reason) {
  if (vm == nullptr || number == 0 || reason == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  const Busy busy(*vm);
  if (vm->machine.fault().number != 0) return IPOS_OK;
  vm->machine.raise_fault(number, reason);
  tell_fault(*vm);
  return IPOS_OK;
}
