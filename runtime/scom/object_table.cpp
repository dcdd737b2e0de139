// Setting up variable telegrams. The order of checks decides which of several reasons a program sees.
#include "runtime/scom/object_table.hpp"

#include <algorithm>
#include <cassert>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

using stdlib::ObjectClass;
using stdlib::Trait;

constexpr size_t kReceiveFlags[] = {stdlib::system_variable("RecStatS1"), stdlib::system_variable("RecStatS2")};

#define UNIT(code, name, title, family, lists, variables, parameter_words, program_words, tasks, depth, receive, ...) \
  static_assert((receive) <= ObjectTable::kMostReceive);
#include "stdlib/unit_types.def"

// The unit's own MOVILINK telegram with this identifier (1053 1610 p. 51): closed to its objects.
bool is_movilink_identifier(uint32_t id, const SlaveSettings& profile) {
  const auto used = classify_identifier(id);
  if (!used || !has_telegram(profile, used->telegram)) return false;
  return used->address == (telegram_type(used->telegram).grouped ? profile.group : profile.address);
}

// Of all classes together.
uint32_t most_cyclic(const stdlib::UnitType& unit) {
  uint32_t most = 0;
  for (const ObjectClass& objects : unit.objects) most += objects.objects;
  return most;
}

uint8_t results_of(ObjectKind kind) { return kind == ObjectKind::TransmitCyclic ? 5 : 3; }

}  // namespace

ObjectRequest ObjectTable::request(ObjectKind kind, uint32_t variable, std::span<const int32_t> h) const {
  assert(variable + results_of(kind) <= h.size());
  const bool cyclic = kind == ObjectKind::TransmitCyclic;
  const uint32_t at = variable + (cyclic ? 3 : 1);  // where length and pointer stand in the structure
  const int32_t object = h[variable];
  ObjectRequest out{kind, object, 0, 0, h[at], h[at + 1], variable + results_of(kind)};
  if (sbus_ == 2 && object >= 0) out.object &= ~kSbus2Object;
  if (cyclic) {
    out.cycle = h[variable + 1];
    out.offset = h[variable + 2];
  }
  return out;
}

ObjectVerdict ObjectTable::judge(const ObjectRequest& request) const {
  const auto format = variable_format(request.format);
  if (!format) return ObjectVerdict::NoFormat;
  if (request.data < 0 || static_cast<uint32_t>(request.data) + format->variables() > unit_->variables)
    return ObjectVerdict::NoVariables;
  if (request.object < 0) return ObjectVerdict::NoIdentifier;
  if ((request.object & kSbus2Object) != 0 && unit_->has(Trait::Sbus2))
    return ObjectVerdict::OnSbus2;
  if (static_cast<uint32_t>(request.object) >= kStandardIdLimit) return ObjectVerdict::NoIdentifier;
  if (is_movilink_identifier(static_cast<uint32_t>(request.object), profile_))
    return ObjectVerdict::ClosedIdentifier;
  return ObjectVerdict::Accepted;
}

ObjectVerdict ObjectTable::define(const ObjectRequest& request, std::span<int32_t> h) {
  ObjectVerdict verdict = judge(request);
  if (verdict == ObjectVerdict::NoVariables) return verdict;
  // No manual prints results for what judge() refuses; ours are those of a refused object.
  int32_t result = request.kind == ObjectKind::TransmitCyclic ? kWrongCycleTime
                                                              : static_cast<int32_t>(AcyclicStatus::Failed);
  if (verdict == ObjectVerdict::Accepted) switch (request.kind) {
      case ObjectKind::TransmitCyclic: verdict = define_cyclic(request, result); break;
      case ObjectKind::Receive: verdict = define_receive(request); break;
      case ObjectKind::TransmitAcyclic: return verdict;
    }
  if (request.kind != ObjectKind::Receive) h[request.result] = result;
  return verdict;
}

ObjectVerdict ObjectTable::define_cyclic(const ObjectRequest& request, int32_t& result) {
  result = kWrongCycleTime;
  const ObjectClass* like = unit_->objects_of(request.cycle);
  if (like == nullptr) return ObjectVerdict::WrongCycleTime;
  if (!like->has_offset(request.offset, request.cycle)) return ObjectVerdict::WrongOffset;
  if (sends(request.object)) return ObjectVerdict::SentTwice;
  if (receives(request.object)) return ObjectVerdict::SentAndReceived;
  int of_class = 0;
  for (const Cyclic& object : std::span(state_.cyclic).first(state_.cyclic_count))
    of_class += like->has_cycle(object.cycle);
  result = kTooManyObjects;
  if (of_class >= like->objects) return ObjectVerdict::TooManyTransmit;
  const Cyclic object{static_cast<uint16_t>(request.object), static_cast<uint16_t>(request.cycle),
                      static_cast<uint16_t>(request.offset), static_cast<uint16_t>(request.data),
                      *variable_format(request.format)};
  result = free_capacity(object);
  if (result == kBusOverload) return ObjectVerdict::Overload;
  assert(state_.cyclic_count < state_.cyclic.size());
  state_.cyclic[state_.cyclic_count++] = object;
  return ObjectVerdict::Accepted;
}

// The whole percent of the 70 % budget still free (docs/reference/stdlib.md).
int32_t ObjectTable::free_capacity(const Cyclic& added) const {
  constexpr uint64_t kMicro = 1'000'000;  // loads are summed in millionths of a bit per second
  const auto load = [](const Cyclic& object) {
    return worst_case_bits(object.format.length, false) * 1000 * kMicro / object.cycle;
  };
  uint64_t used = load(added);
  for (const Cyclic& object : std::span(state_.cyclic).first(state_.cyclic_count)) used += load(object);
  const uint64_t budget = uint64_t{baud_} * 70 / 100 * kMicro;
  return used > budget ? kBusOverload : static_cast<int32_t>((budget - used) / (budget / 100));
}

ObjectVerdict ObjectTable::define_receive(const ObjectRequest& request) {
  if (state_.closed) return ObjectVerdict::TooLate;
  if (receives(request.object)) return ObjectVerdict::ReceivedTwice;
  if (sends(request.object)) return ObjectVerdict::SentAndReceived;
  if (state_.receive_count >= unit_->receive_objects) return ObjectVerdict::TooManyReceive;
  assert(state_.receive_count < state_.receive.size());
  state_.receive[state_.receive_count++] = {static_cast<uint16_t>(request.object),
                                            static_cast<uint16_t>(request.data),
                                            *variable_format(request.format)};
  return ObjectVerdict::Accepted;
}

bool ObjectTable::sends(int32_t object) const {
  const auto known = std::span(state_.cyclic).first(state_.cyclic_count);
  return std::any_of(known.begin(), known.end(), [&](const Cyclic& sent) { return sent.id == object; });
}

bool ObjectTable::receives(int32_t object) const {
  const auto known = std::span(state_.receive).first(state_.receive_count);
  return std::any_of(known.begin(), known.end(), [&](const Receive& taken) { return taken.id == object; });
}

Frame ObjectTable::acyclic_frame(const ObjectRequest& request, std::span<const int32_t> h) {
  return object_frame(static_cast<uint32_t>(request.object), *variable_format(request.format),
                      static_cast<uint32_t>(request.data), h);
}

void ObjectTable::note_acyclic(uint32_t tag, AcyclicStatus status, std::span<int32_t> h) {
  if (tag >= kAcyclicTags && tag - kAcyclicTags + 3 < h.size())
    h[tag - kAcyclicTags + 3] = static_cast<int32_t>(status);
}

void ObjectTable::start(int64_t tick) {
  if (state_.started) return;
  state_.started = true;
  state_.closed = true;
  state_.start_tick = tick;
}

int64_t ObjectTable::next_due(size_t n, int64_t tick) const {
  const Cyclic& object = state_.cyclic[n];
  const int64_t first = state_.start_tick + object.offset;
  const int64_t done = tick < first ? 0 : (tick - first) / object.cycle + 1;
  return first + done * object.cycle;
}

std::optional<size_t> ObjectTable::receiver(const Frame& frame) const {
  if (!state_.started || !is_plain(frame)) return std::nullopt;
  for (size_t n = 0; n < state_.receive_count; ++n)
    if (state_.receive[n].id == frame.id) return n;
  return std::nullopt;
}

bool ObjectTable::take(size_t receiver, const Frame& frame, std::span<int32_t> h) const {
  const Receive& object = state_.receive[receiver];
  const auto pair = frame_variables(frame, object.format);
  if (!pair) return false;
  if (object.format.variables() > 0) h[object.data] = pair->low;
  if (object.format.variables() > 1) h[object.data + 1] = pair->high;
  if (unit_->has(Trait::NewVariables)) {
    int32_t& flags = h[kReceiveFlags[sbus_ - 1]];
    flags = static_cast<int32_t>(static_cast<uint32_t>(flags) | 1U << receiver);
  }
  return true;
}

bool ObjectTable::has_taken(size_t receiver, const Frame& frame, std::span<const int32_t> h) const {
  const Receive& object = state_.receive[receiver];
  const auto pair = frame_variables(frame, object.format);
  if (!pair) return false;
  if (object.format.variables() > 0 && h[object.data] != pair->low) return false;
  if (object.format.variables() > 1 && h[object.data + 1] != pair->high) return false;
  return !unit_->has(Trait::NewVariables) ||
         (static_cast<uint32_t>(h[kReceiveFlags[sbus_ - 1]]) >> receiver & 1) != 0;
}

bool ObjectTable::is_sound(uint32_t id, VariableFormat format, uint32_t data) const {
  return id < kStandardIdLimit && format.length <= 8 && format.layout <= VariableLayout::Intel &&
         data + format.variables() <= unit_->variables;
}

bool ObjectTable::restore(const State& state) {
  if (state.cyclic_count > most_cyclic(*unit_) || state.receive_count > unit_->receive_objects) return false;
  for (const Cyclic& object : std::span(state.cyclic).first(state.cyclic_count))
    if (object.cycle == 0 || !is_sound(object.id, object.format, object.data)) return false;
  for (const Receive& object : std::span(state.receive).first(state.receive_count))
    if (!is_sound(object.id, object.format, object.data)) return false;
  state_ = state;
  return true;
}

}  // namespace ipos::runtime
