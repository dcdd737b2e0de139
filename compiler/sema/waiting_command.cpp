// VARINT, commands that wait in interrupt routines or longer than the watchdog, and commands that a unit does not have.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compiler/sema/command_check.hpp"
#include "compiler/sema/command_writes.hpp"

namespace ipos::compiler {
namespace {

using vm::Opcode;

struct VarintMember {
  enum : uint32_t { Control, IntNum, SrcVar, CompareVar, Mode, Priority };
};

// docs/reference/stdlib.md, variable interrupts.
struct ElementRange {
  uint32_t element;
  const char* name;
  int32_t most;
};
constexpr ElementRange kRanges[] = {{VarintMember::Control, "Control", 2}, {VarintMember::IntNum, "IntNum", 3}, {VarintMember::Mode, "Mode", 9}, {VarintMember::Priority, "Priority", 10}};

constexpr int32_t kModesOfMasks[] = {1, 2, 3, 8};  // VI_CHANGED, VI_RISING, VI_FALLING, VI_ANY

int32_t word(const ConstantFlow::Point& point, size_t argument) {
  const int32_t* known = std::get_if<int32_t>(&point.call.arguments[argument]);
  return known != nullptr ? *known : 0;
}

bool is_travel(Opcode opcode) {
  switch (opcode) {
    case Opcode::GoAbsH:
    case Opcode::GoAbsK:
    case Opcode::GoRelH:
    case Opcode::GoRelK:
    case Opcode::Go0: return true;
    default: return false;
  }
}

// Whether the condition holds while the variable is 0.
bool holds_at_zero(int32_t mode, int32_t compare) {
  switch (mode) {
    case 4: return compare == 0;  // VI_EQ
    case 5: return compare != 0;  // VI_NE
    case 6: return compare <= 0;  // VI_GE
    case 7: return compare >= 0;  // VI_LE
    case 9: return true;          // VI_NONE
    default: return false;
  }
}

}  // namespace

void CommandCheck::check_interrupt(const Point& point) {
  const uint32_t first = order_block(point.call).first;
  for (const ElementRange& range : kRanges)
    refuse(Diag::InterruptValue, first + range.element, [&](int32_t value) {
      return value >= 0 && value <= range.most
                 ? std::string()
                 : fmt::format("{} {} of a variable interrupt is fault F10: 0 to {}", range.name, value, range.most);
    });
  const KnownValue* control = flow_.only(first + VarintMember::Control);
  if (control == nullptr || control->value == 0) return;
  const KnownValue* priority = flow_.only(first + VarintMember::Priority);
  if (priority != nullptr && !priority->assigned() && priority->value == 0)
    warn(Diag::InterruptOff, point.expr.span,
         {fmt::format("Priority of '{}' is never set, and 0 switches the interrupt off; 1 to 10 switch it on",
                      name_of(first))});
  check_mask(point, first);
  check_source(point, first);
  check_number(point, first);
  const Opcode start = control->value == 1 ? Opcode::Task2 : Opcode::Task;
  for (const ProgramRoot& root : roots_.roots)
    if (root.start == start) return;
  if (control->value > 2) return;
  warn(Diag::InterruptOff, place(*control, point),
       {fmt::format("Control {} takes the interrupt to task {}, which nothing starts", control->value,
                    control->value + 1)});
}

// A mask without a bit changes, rises, falls and is there never.
void CommandCheck::check_mask(const Point& point, uint32_t first) {
  const KnownValue* mode = flow_.only(first + VarintMember::Mode);
  const KnownValue* mask = flow_.only(first + VarintMember::CompareVar);
  const bool masks = mode != nullptr && std::find(std::begin(kModesOfMasks), std::end(kModesOfMasks), mode->value) != std::end(kModesOfMasks);
  if (!masks || mask == nullptr || mask->value != 0) return;
  warn(Diag::InterruptOff, place(*mask, point),
       {fmt::format("CompareVar of '{}' {}, a mask without a bit; bit n is 1 << n", name_of(first),
                    mask->assigned() ? "is 0" : "is never set, so it is 0")});
}

// A variable that stays 0.
void CommandCheck::check_source(const Point& point, uint32_t first) {
  const KnownValue* source = flow_.only(first + VarintMember::SrcVar);
  const KnownValue* mode = flow_.only(first + VarintMember::Mode);
  const KnownValue* compare = flow_.only(first + VarintMember::CompareVar);
  if (source == nullptr || mode == nullptr || compare == nullptr || !source->assigned() || holds_at_zero(mode->value, compare->value)) return;
  if (stays_zero(source->value))
    warn(Diag::InterruptOff, place(*source, point), {fmt::format("nothing writes '{}'", name_of(static_cast<uint32_t>(source->value)))});
}

// Two structures are two interrupts, but a number that is never set is 0 in each.
void CommandCheck::check_number(const Point& point, uint32_t first) {
  const KnownValue* number = flow_.only(first + VarintMember::IntNum);
  if (number == nullptr || number->value != 0) return;
  if (!number->assigned() && first_of_number_0_ && *first_of_number_0_ != first)
    warn(Diag::InterruptValue, point.expr.span,
         {fmt::format("IntNum of '{}' is never set, so it is 0 as that of '{}', whose interrupt it replaces", name_of(first),
                      name_of(*first_of_number_0_))});
  if (!first_of_number_0_) first_of_number_0_ = first;
}

void CommandCheck::check_waiting(const Point& point) {
  const Opcode opcode = point.call.opcode;
  const KnownValue* value = opcode == Opcode::WaitH ? flow_.only_of(point.value) : nullptr;
  const int32_t ms = opcode == Opcode::WaitK ? word(point, 0) : value != nullptr ? value->value : 0;
  if (ms > 0) {
    const std::span<const KnownValue> watchdog = flow_.values(ConstantFlow::kWatchdog);
    bool shorter = !watchdog.empty();
    for (const KnownValue& known : watchdog) shorter = shorter && known.value >= 0 && known.value < ms;
    if (shorter)
      if (Diagnostic* message = warn(Diag::WatchdogTooShort, point.expr.span,
                                     {fmt::format("{}", ms), fmt::format("{}", watchdog.front().value)});
          message != nullptr && watchdog.front().assigned()) {
        message->notes.push_back({watchdog.front().span, "it is started here"});
        short_watchdogs_.insert(watchdog.front().span.begin.value);
      }
  }
  const ProgramRoot& root = roots_.roots[point.root];
  if (!root.is_interrupt()) return;
  bool waits = ms > 0 || opcode == Opcode::WaitH || opcode == Opcode::Movlnk;
  if (opcode == Opcode::Movlnk)
    for (const KnownValue& address : flow_.values(order_block(point.call).first + MovlnkMember::Address))
      waits = waits && address.value != kOwnUnitAddress;
  // Keywords of GO0: bit 0 is NW, 8 ends a reference travel; of the others 1 is WAIT.
  if (is_travel(opcode))
    waits = opcode == Opcode::Go0 ? word(point, 0) % 2 == 0 && word(point, 0) != 8 : word(point, 0) == 1;
  if (!waits) return;
  if (Diagnostic* message =
          warn(Diag::WaitInInterrupt, point.expr.span, {context_.program.functions[root.function].name})) {
    message->notes.push_back({root.place, "it is installed here"});
    message->notes.push_back({{}, is_travel(opcode) ? "the forms with NOWAIT or NW only start the travel"
                                                    : "a task can do it: set a variable here that the task looks at"});
  }
}

void CommandCheck::operator()(const ConstantFlow::Unfed& unfed) {
  const Span place = unfed.watchdog.front().span;
  if (short_watchdogs_.contains(place.begin.value)) return;
  Diagnostic* message = warn(Diag::WatchdogUnfed, place, {unfed.loop.begin.valid() ? "the endless loop behind it" : "the rest of the program"});
  if (message != nullptr && unfed.loop.begin.valid()) message->notes.push_back({unfed.loop, "this loop"});
}

void CommandCheck::check_lacking(const Point& point) {
  const Opcode opcode = point.call.opcode;
  const char* reason = nullptr;
  if (opcode == Opcode::MovCom || opcode == Opcode::MovOn) reason = "ipos does not simulate MOVCOM and MOVON";
  const bool positions = is_travel(opcode) || opcode == Opcode::TouchProbe || opcode == Opcode::AxisStop;
  if (positions && !context_.unit.has(stdlib::Trait::Positioning)) reason = "this unit does not position";
  if (reason != nullptr) warn(Diag::CommandLacking, point.expr.span, {reason});
}

}  // namespace ipos::compiler
