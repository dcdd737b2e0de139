// Installing interrupts and beginning their routines. Ours, as no page read says it: an event that repeats
// while its routine runs or waits its turn is remembered once; a stopped task takes no interrupts, and what
// happens meanwhile is not made up for; DISABLE ends all three of task 1.
#include "vm/exec/interrupts.hpp"

#include "vm/context/arithmetic.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::vm {
namespace {

// Elements of the VARINT structure (IPOSplus p. 347; the last three ours, see stdlib/structures.def).
enum Element : size_t { kControl, kIntNum, kSrcVar, kCompareVar, kMode, kPriority, kIntEvent };

constexpr const char* kNames[kContexts] = {"task 1",
                                           "task 2",
                                           "task 3",
                                           "interrupt ERROR",
                                           "interrupt TOUCH PROBE",
                                           "interrupt TIMER 0",
                                           "variable interrupt 0",
                                           "variable interrupt 1",
                                           "variable interrupt 2",
                                           "variable interrupt 3"};

constexpr uint32_t request(int number) { return 1U << number; }

}  // namespace

const char* context_name(int context) { return kNames[context - 1]; }

bool VariableInterrupt::look(int32_t value) {
  const auto mask = static_cast<uint32_t>(compare);
  const auto now = static_cast<uint32_t>(value);
  const auto before = static_cast<uint32_t>(last);
  last = value;
  bool condition = false;
  switch (mode) {
    case CompareMode::Never: return false;
    case CompareMode::Changed: return ((now ^ before) & mask) != 0;
    case CompareMode::Rising: return (now & ~before & mask) != 0;
    case CompareMode::Falling: return (~now & before & mask) != 0;
    case CompareMode::Equal: condition = value == compare; break;
    case CompareMode::NotEqual: condition = value != compare; break;
    case CompareMode::AtLeast: condition = value >= compare; break;
    case CompareMode::AtMost: condition = value <= compare; break;
    case CompareMode::AnySet: condition = (now & mask) != 0; break;
    case CompareMode::NoneSet: condition = (now & mask) == 0; break;
  }
  const bool event = condition && !held;
  held = condition;
  return event;
}

void Machine::raise_event(Event event) {
  EventInterrupt& interrupt = interrupts_.events[static_cast<size_t>(event)];
  if (interrupt.installed && context_at(1).state != TaskState::Stopped) interrupt.pending = true;
}

// SETINT; the keyword DISABLE is 0, the others are in the order below.
void Machine::set_interrupt(int32_t keyword, uint32_t address) {
  if (keyword == 0) {
    interrupts_.events = {};
    see_interrupts();
    return;
  }
  static constexpr Event kByKeyword[] = {Event::Error, Event::Timer0, Event::TouchProbe};
  EventInterrupt& interrupt = interrupts_.events[static_cast<size_t>(kByKeyword[keyword - 1])];
  interrupt.installed = true;
  interrupt.address = address;
  see_interrupts();
}

// VARINT copies its structure, so that later changes of it do nothing (IPOSplus p. 347).
const char* Machine::set_variable_interrupt(uint32_t structure, uint32_t address) {
  const auto element = [&](Element n) { return h_[structure + n]; };
  if (element(kControl) == 0) {
    interrupts_.variables = {};
    see_interrupts();
    return nullptr;
  }
  if (element(kControl) < 0 || element(kControl) > 2) return "Control of VARINT is none of 0, 1, 2";
  if (element(kIntNum) < 0 || element(kIntNum) >= kVariableInterrupts)
    return "IntNum of VARINT is none of 0..3";
  if (bits(element(kSrcVar)) >= program_.limits().variables)
    return "SrcVar of VARINT is no variable of the unit";
  if (element(kMode) < 0 || element(kMode) >= kCompareModes) return "Mode of VARINT is none of 0..9";
  if (element(kPriority) < 0 || element(kPriority) > kMaxPriority)
    return "Priority of VARINT is none of 0..10";
  VariableInterrupt& interrupt = interrupts_.variables[bits(element(kIntNum))];
  interrupt = {};
  interrupt.installed = element(kPriority) != 0;
  interrupt.mode = static_cast<CompareMode>(element(kMode));
  interrupt.task = static_cast<uint8_t>(element(kControl) + 1);
  interrupt.priority = static_cast<uint8_t>(element(kPriority));
  interrupt.source = static_cast<uint16_t>(element(kSrcVar));
  interrupt.structure = static_cast<uint16_t>(structure);
  interrupt.compare = element(kCompareVar);
  interrupt.last = h_[interrupt.source];
  interrupt.address = address;
  see_interrupts();
  return nullptr;
}

// After a routine has begun or ended.
void Machine::choose_active(int task) {
  int active = task;
  for (int number = kTasks + 1; number <= kContexts; ++number) {
    const TaskContext& t = context(number);
    if (t.state != TaskState::Stopped && t.task == task && t.rank > context(active).rank) active = number;
  }
  active_[static_cast<size_t>(task - 1)] = static_cast<uint8_t>(active - 1);
}

// After interrupts have been installed or removed.
void Machine::see_interrupts() {
  events_ = watches_ = false;
  for (const EventInterrupt& interrupt : interrupts_.events)
    events_ = events_ || interrupt.installed;
  for (const VariableInterrupt& interrupt : interrupts_.variables) watches_ = watches_ || interrupt.installed;
}

// Begins the routine unless the task runs one that is not below it.
bool Machine::begin_routine(int number, int task, uint8_t rank, uint32_t address) {
  if (context_at(number).state != TaskState::Stopped || context(active_context(task)).rank >= rank)
    return false;
  begin(number, address);
  context_at(number).task = static_cast<uint8_t>(task);
  context_at(number).rank = rank;
  choose_active(task);
  return true;
}

// One of the installed events is looked at in a millisecond, in turn: so one installed interrupt answers
// within 1 ms, two within 2, three within 3 (IPOSplus p. 45).
void Machine::take_events() {
  size_t installed = 0;
  for (EventInterrupt& interrupt : interrupts_.events) {
    if (context_at(1).state == TaskState::Stopped) interrupt.pending = false;
    installed += interrupt.installed;
  }
  if (installed == 0) return;
  size_t turn = interrupts_.turn % installed;
  interrupts_.turn = static_cast<uint8_t>((turn + 1) % installed);
  for (size_t n = 0; n < interrupts_.events.size(); ++n) {
    EventInterrupt& interrupt = interrupts_.events[n];
    if (!interrupt.installed || turn-- != 0) continue;
    const auto rank = static_cast<uint8_t>(kEvents - n);
    if (interrupt.pending && begin_routine(context_of(static_cast<Event>(n)), 1, rank, interrupt.address))
      interrupt.pending = false;
    return;
  }
}

void Machine::take_variable_interrupts() {
  if (program_.limits().variables <= kVarIntReq) return;
  auto requests = bits(h_[kVarIntReq]);
  for (int n = 0; VariableInterrupt & interrupt : interrupts_.variables) {
    // A stopped task has its variable looked at, too: what happens meanwhile is over when it starts.
    const bool event = interrupt.installed && interrupt.look(h_[interrupt.source]);
    if (!interrupt.installed || context_at(interrupt.task).state == TaskState::Stopped) {
      requests &= ~request(n);
    } else if (event) {
      requests |= request(n);
      h_[interrupt.structure + kIntEvent] = interrupt.last;
    }
    ++n;
  }
  // The highest priority first, of equals the lowest number.
  for (uint8_t priority = requests != 0 ? kMaxPriority : 0; priority > 0; --priority)
    for (int n = 0; const VariableInterrupt& interrupt : interrupts_.variables) {
      if (interrupt.priority == priority && (requests & request(n)) != 0 &&
          begin_routine(context_of_variable_interrupt(n), interrupt.task, priority, interrupt.address))
        requests &= ~request(n);
      ++n;
    }
  h_[kVarIntReq] = static_cast<int32_t>(requests);
}

}  // namespace ipos::vm
