// SCOM: format, offset, data and number of a variable telegram (1053 1610 p. 54 to 56), as the unit judges them
// (runtime/scom). Cycle times, identifiers and the number of objects: sbus_check.cpp.
#include <fmt/format.h>

#include "compiler/sema/command_check.hpp"
#include "compiler/sema/command_writes.hpp"
#include "stdlib/unit_names.hpp"

namespace ipos::compiler {
namespace {

constexpr int32_t kIntel = 0x100;  // added to the length

// Bytes of a telegram, -1: no such format.
int32_t length_of(int32_t format) {
  const int32_t length = format >= kIntel ? format - kIntel : format;
  return length < 0 || length > 8 ? -1 : length;
}

}  // namespace

void CommandCheck::check_object(const Point& point) {
  const int32_t kind = std::get<int32_t>(point.call.arguments[0]);
  const uint32_t first = order_block(point.call).first;
  const uint32_t format = first + (kind == kTransmitCyclic ? 3 : 1);
  refuse(Diag::SbusObject, format, [](int32_t value) {
    return length_of(value) >= 0 ? std::string()
                                 : fmt::format("Format {} is refused: it is the number of bytes, 0 to 8, and 100h more for "
                                               "INTEL",
                                               value);
  });
  if (kind == kTransmitCyclic) check_offset(first);
  if (kind != kTransmitAcyclic) check_twice(point, first, kind == kReceive);
  const KnownValue* started = flow_.only(ConstantFlow::kSbusStarted);
  if (kind == kReceive && started != nullptr && started->value == 1)
    if (Diagnostic* message = warn(Diag::ObjectTooLate, point.expr.span, {}); message != nullptr && started->assigned())
      message->notes.push_back({started->span, "the telegrams are started here"});
  const KnownValue* bytes = flow_.only(format);
  const KnownValue* pointer = flow_.only(format + 1);
  if (pointer != nullptr && (pointer->assigned() || (bytes != nullptr && bytes->assigned())))
    check_object_data(point, first, kind == kReceive, bytes == nullptr ? 0 : length_of(bytes->value), *pointer);
}

void CommandCheck::check_offset(uint32_t first) {
  const KnownValue* cycle = flow_.only(first + 1);
  const stdlib::ObjectClass* like = cycle == nullptr ? nullptr : context_.unit.objects_of(cycle->value);
  if (like == nullptr) return;
  refuse(Diag::SbusObject, first + 2, [&](int32_t offset) {
    if (like->has_offset(offset, cycle->value)) return std::string();
    return fmt::format("offset {} is refused with a cycle time of {} ms (Result -1): 0 to {} ms{}", offset, cycle->value,
                       like->rule == stdlib::OffsetRule::OffsetBelowCycle ? cycle->value - like->offset_step
                                                                          : like->longest_offset,
                       like->offset_step == 1 ? "" : fmt::format(" in steps of {}", like->offset_step));
  });
}

// One structure may define several objects, but each under a number of its own.
void CommandCheck::check_twice(const Point& point, uint32_t first, bool receive) {
  const KnownValue* object = flow_.only(first);
  const bool known = object != nullptr && object->assigned();
  const auto [at, fresh] = objects_.try_emplace(&point.expr, Object{known ? std::optional(object->value) : std::nullopt, receive});
  if (!fresh && (!known || at->second.number != object->value)) at->second.number.reset();
  if (!known) return;
  for (const ConstantFlow::Defined& earlier : flow_.defined()) {
    if (earlier.object != object->value || earlier.structure != first || earlier.place == point.expr.span) continue;
    if (Diagnostic* message = warn(Diag::ObjectTwice, point.expr.span,
                                   {fmt::format("{}", object->value), receive ? "received" : "sent"}))
      message->notes.push_back({earlier.place, "it is set up here"});
    return;
  }
}

// `bytes` 0: not known, which may be one variable or two.
void CommandCheck::check_object_data(const Point& point, uint32_t first, bool receive, int32_t bytes,
                                     const KnownValue& pointer) {
  const uint32_t count = bytes > 4 ? 2 : 1;
  if (beyond_unit(point, pointer, count)) return;
  const auto data = static_cast<uint32_t>(pointer.value);
  const uint32_t size = order_block(point.call).size;
  if (data + count > first && data < first + size) {
    warn(Diag::OwnDefinition, place(pointer, point), {receive ? "received into" : "sent from", name_of(first)});
    return;
  }
  if (!receive && bytes > 0) {
    bool never = true;
    for (uint32_t n = 0; n < count; ++n) never = never && stays_zero(pointer.value + static_cast<int32_t>(n));
    if (never) warn(Diag::NeverWritten, place(pointer, point), {name_of(data), "sent"});
  }
  const Reach all = reach(pointer.value, count);
  if (!(receive ? is_neighbour(all) : all.beyond != nullptr && !all.first->type.scalar())) return;
  Diagnostic* message = warn(Diag::DataBeyondVariable, place(pointer, point),
                             {fmt::format("a telegram of {} bytes", bytes), fmt::format("{}", count), all.first->name,
                              fmt::format("{}", all.own), all.beyond->name, receive ? "overwritten" : "sent"});
  if (message != nullptr) message->notes.push_back({all.beyond->span, "it is declared here"});
}

}  // namespace ipos::compiler
