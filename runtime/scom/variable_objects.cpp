// Variable telegrams on the simulated bus: the table (runtime/scom) decides, here its frames are queued and
// its verdicts become reasons a user can read.
#include "runtime/scom/variable_objects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/can/identifier_text.hpp"
#include "stdlib/unit_names.hpp"
#include "stdlib/unit_text.hpp"

namespace ipos::runtime {

std::string object_words(int32_t object) {
  return object < 0 || object >= static_cast<int32_t>(kStandardIdLimit)
             ? fmt::format("{}", object)
             : id_words(static_cast<uint32_t>(object));
}

VariableObjects::VariableObjects(const stdlib::UnitType& unit, uint32_t baud, FrameSender& sender,
                                 uint64_t first_tag, int sbus)
    : sender_(sender), first_tag_(first_tag), unit_(unit), table_(unit, baud, sbus) {}

bool VariableObjects::define(ObjectKind kind, uint32_t variable, std::span<int32_t> h, std::string& why) {
  const ObjectRequest request = table_.request(kind, variable, h);
  const ObjectVerdict verdict = table_.define(request, h);
  forget_due();
  if (verdict == ObjectVerdict::NoVariables) return false;
  ObjectDefinition definition{kind, variable,      request.object, variable_format(request.format),
                              0,    request.cycle, request.offset, verdict == ObjectVerdict::Accepted,
                              {}};
  // Which data it would have is known of what could be an object at all.
  if (verdict == ObjectVerdict::Accepted || verdict > ObjectVerdict::ClosedIdentifier)
    definition.data = static_cast<uint32_t>(request.data);
  if (verdict != ObjectVerdict::Accepted) {
    why = reason(request, verdict);
  } else {
    if (kind == ObjectKind::TransmitAcyclic) {
      const uint32_t tag = ObjectTable::kAcyclicTags + variable;
      const bool queued =
          sender_.send(ObjectTable::acyclic_frame(request, h), first_tag_ + tag) == SendStatus::Queued;
      ObjectTable::note_acyclic(tag, queued ? AcyclicStatus::Sending : AcyclicStatus::Failed, h);
    }
    if (kind == ObjectKind::Receive) sender_.listen(static_cast<uint32_t>(request.object));
    const SlaveSettings& profile = table_.profile();
    if (profile.synchronous && request.object == profile.sync_id)
      why = fmt::format("object number {} is also the sync telegram of this unit ({})", object_words(request.object),
                        stdlib::unit_text(table_.unit(), "{P885 or P895|P885|P817}"));
    // The table keeps no acyclic objects.
    if (const ObjectDefinition* other = another_use(definition);
        other != nullptr &&
        (kind == ObjectKind::TransmitAcyclic || other->kind == ObjectKind::TransmitAcyclic))
      why = fmt::format(
          "object {} stands in two structures of this unit (H{} and H{}), which may use an "
          "identifier once",
          object_words(request.object), other->variable, variable);
  }
  definition.why = why;
  remember(definition);
  return true;
}

std::string VariableObjects::reason(const ObjectRequest& request, ObjectVerdict verdict) const {
  const std::string id = object_words(request.object);
  switch (verdict) {
    case ObjectVerdict::Accepted:
    case ObjectVerdict::NoVariables: return {};
    case ObjectVerdict::NoFormat:
      return fmt::format("object {}: Format {:#x} is not 0..8 or 0x100..0x108; the object is not set up", id,
                         static_cast<uint32_t>(request.format));
    case ObjectVerdict::OnSbus2:
      return fmt::format("object {} is for SBus 2, which the station is not on; the object is not set up",
                         object_words(request.object & ~kSbus2Object));
    case ObjectVerdict::NoIdentifier:
      return fmt::format("object number {} is not 0..2047; the object is not set up", id);
    case ObjectVerdict::ClosedIdentifier:
      return fmt::format(
          "object number {} is an identifier of the unit's own MOVILINK telegrams; the object is not set up",
          id);
    case ObjectVerdict::WrongCycleTime:
      return fmt::format("object {}: a cycle time of {} ms is not allowed; the object is not sent", id,
                         request.cycle);
    case ObjectVerdict::WrongOffset:
      return fmt::format("object {}: an offset of {} ms is not allowed with {} ms; the object is not sent",
                         id, request.offset, request.cycle);
    case ObjectVerdict::SentTwice:
      return fmt::format("object {} is already sent by this unit; the second definition is not used", id);
    case ObjectVerdict::SentAndReceived:
      return fmt::format(
          "object {} would be sent and received by this unit, which may use an identifier once; the second "
          "definition is not used",
          id);
    case ObjectVerdict::TooManyTransmit: {
      const stdlib::ObjectClass& like = *unit_.objects_of(request.cycle);
      return fmt::format("object {}: the unit has only {} transmit objects of {}; the object is not sent", id,
                         like.objects, stdlib::cycle_text(like));
    }
    case ObjectVerdict::Overload:
      return fmt::format(
          "object {}: the cyclic objects of this unit would load the bus beyond 70 %; the object is not sent",
          id);
    case ObjectVerdict::TooLate:
      return fmt::format("receive object {} is defined after _SBusCommOn; it is not used", id);
    case ObjectVerdict::ReceivedTwice:
      return fmt::format("object {} is already received by this unit; the second definition is not used", id);
    case ObjectVerdict::TooManyReceive:
      return fmt::format("receive object {}: the unit has only {} receive objects; it is not used", id,
                         unit_.receive_objects);
  }
  return {};
}

const ObjectDefinition* VariableObjects::another_use(const ObjectDefinition& definition) const {
  for (const ObjectDefinition& known : definitions_)
    if (known.accepted && known.object == definition.object &&
        (known.variable != definition.variable || known.kind != definition.kind))
      return &known;
  return nullptr;
}

const ObjectDefinition* VariableObjects::object(uint32_t id) const {
  for (const ObjectDefinition& known : definitions_)
    if (known.accepted && known.object == static_cast<int32_t>(id)) return &known;
  return nullptr;
}

void VariableObjects::remember(const ObjectDefinition& definition) {
  for (ObjectDefinition& known : definitions_) {
    if (known.kind != definition.kind || known.variable != definition.variable) continue;
    if (!known.accepted || definition.accepted) known = definition;
    return;
  }
  definitions_.push_back(definition);
}

void VariableObjects::start(int64_t tick) {
  table_.start(tick);
  forget_due();
}

void VariableObjects::pause() {
  forget_due();
  for (uint32_t n = 0; n < table_.state().cyclic_count; ++n) sender_.withdraw(first_tag_ + n);
  table_.pause();
}

void VariableObjects::stop() {
  pause();
  table_.stop();
}

void VariableObjects::send_due(int64_t tick, std::span<const int32_t> h) {
  int64_t next = INT64_MAX;
  for (size_t n = 0; n < table_.sending(); ++n) {
    int64_t& due = due_of_[n];
    if (due < tick) due = table_.next_due(n, tick - 1);
    if (due == tick) {
      // A telegram that is still waiting for the bus is overtaken by the new values.
      sender_.send_latest(table_.frame(n, h), first_tag_ + n);
      due += table_.state().cyclic[n].cycle;
    }
    next = std::min(next, due);
  }
  due_ = next;
}

void VariableObjects::forget_due() {
  due_ = kUnknown;
  due_of_.fill(kUnknown);
}

bool VariableObjects::on_frame(const Frame& frame, std::span<int32_t> h, std::string& why) const {
  const auto receiver = table_.receiver(frame);
  if (!receiver) return false;
  if (table_.take(*receiver, frame, h)) return true;
  why = fmt::format("object {} came with {} bytes, its receive object has {}; its variables stay as they are",
                    id_words(frame.id), frame.length, table_.state().receive[*receiver].format.length);
  return false;
}

void VariableObjects::on_sent(uint64_t tag, std::span<int32_t> h) {
  ObjectTable::note_acyclic(static_cast<uint32_t>(tag - first_tag_), AcyclicStatus::Sent, h);
}

void VariableObjects::on_not_sent(uint64_t tag, std::span<int32_t> h) {
  if (tag < first_tag_ + ObjectTable::kAcyclicTags) return;
  sender_.withdraw(tag);
  ObjectTable::note_acyclic(static_cast<uint32_t>(tag - first_tag_), AcyclicStatus::Failed, h);
}

}  // namespace ipos::runtime
