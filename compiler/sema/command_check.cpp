// Which check looks at which command, and what they share.
#include "compiler/sema/command_check.hpp"

#include <fmt/format.h>

namespace ipos::compiler {

void CommandCheck::operator()(const Point& point) {
  check_lacking(point);
  switch (point.call.opcode) {
    case vm::Opcode::Scom: return check_object(point);
    case vm::Opcode::Movlnk: check_movilink(point); return check_waiting(point);
    case vm::Opcode::VarInt: return check_interrupt(point);
    case vm::Opcode::Copy: return check_copy(point);
    default: return check_waiting(point);
  }
}

const Variable* CommandCheck::variable_of(uint32_t number) const {
  for (const Variable& variable : context_.scope.variables())
    if (variable.storage != Storage::Alias && number >= variable.number &&
        number < variable.number + variable.type.size())
      return &variable;
  return nullptr;
}

std::string CommandCheck::name_of(uint32_t number) const {
  const Variable* variable = variable_of(number);
  return variable != nullptr ? variable->name : fmt::format("H{}", number);
}

bool CommandCheck::is_written(uint32_t number) const {
  const auto found = context_.accesses.find(number);
  return found != context_.accesses.end() && !found->second.writers.empty();
}

bool CommandCheck::stays_zero(int32_t number) const {
  const auto at = static_cast<uint32_t>(number);
  const Variable* variable = number < 0 ? nullptr : variable_of(at);
  if (variable == nullptr || variable->storage != Storage::Global || at <= kLastNonVolatile || context_.raw_names.contains(at)) return false;
  const auto found = context_.accesses.find(at);
  if (found == context_.accesses.end()) return true;
  for (const AccessPlace& taken : found->second.takers)
    if (!flow_.is_read_through(taken.into)) return false;
  return found->second.writers.empty();
}

// Variables in a row may be meant as a block, an array ends where it ends.
void CommandCheck::check_copy(const Point& point) {
  const auto word = [&](size_t argument) { return std::get<int32_t>(point.call.arguments[argument]); };
  for (const size_t argument : {size_t{0}, size_t{1}}) {
    const Reach all = reach(word(argument), static_cast<uint32_t>(word(2)));
    if (all.beyond == nullptr || all.first->type.count == 0) continue;
    if (Diagnostic* message = warn(Diag::DataBeyondVariable, point.expr.span,
                                   {fmt::format("a copy of {}", word(2)), fmt::format("{}", word(2)), all.first->name,
                                    fmt::format("{}", all.own), all.beyond->name, argument == 0 ? "overwritten" : "copied"}))
      message->notes.push_back({all.beyond->span, "it is declared here"});
  }
}

CommandCheck::Reach CommandCheck::reach(int32_t number, uint32_t count) const {
  Reach out;
  const auto first = static_cast<uint32_t>(number);
  out.first = number < 0 ? nullptr : variable_of(first);
  if (out.first == nullptr) return out;
  out.own = out.first->number + out.first->type.size() - first;
  for (uint32_t n = first + out.own; n < first + count && out.beyond == nullptr; ++n) {
    out.beyond = variable_of(n);
    out.number = n;
  }
  return out;
}

bool CommandCheck::is_neighbour(const Reach& reach) const {
  if (reach.beyond == nullptr) return false;
  if (!reach.first->type.scalar() || !reach.beyond->type.scalar()) return true;
  return is_written(reach.number) && !is_written(reach.first->number);
}

bool CommandCheck::beyond_unit(const Point& point, const KnownValue& pointer, uint32_t count) {
  const int64_t last = int64_t{pointer.value} + count - 1;
  if (pointer.value >= 0 && last < context_.unit.variables) return false;
  const int64_t missing = pointer.value < 0 ? pointer.value : last;
  if (Diagnostic* message = warn(Diag::DataBeyondUnit, place(pointer, point),
                                 {fmt::format("{}", missing), std::string(context_.unit.name),
                                  fmt::format("{}", context_.unit.variables - 1)}))
    message->notes.push_back({point.expr.span, "this command uses it"});
  return true;
}

// A place may be reached on several ways; one message is enough.
Diagnostic* CommandCheck::warn(Diag diag, Span span, std::vector<std::string> args) {
  if (!reported_.emplace(diag, span.begin.value).second) return nullptr;
  return &context_.diagnostics.report(diag, span, std::move(args));
}

}  // namespace ipos::compiler
