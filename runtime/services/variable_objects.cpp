// Setting up, sending and receiving variable telegrams. The order of checks in define_cyclic decides which of
// several reasons a program sees.
#include "runtime/services/variable_objects.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/can/frame_bits.hpp"
#include "runtime/bus/movilink/identifiers.hpp"

namespace ipos::runtime {
namespace {

using stdlib::Generation;

constexpr int32_t kLongestCycle = 65'530;       // ms, 1053 1610 p. 54
constexpr int32_t kLongestFastOffset = 65'534;  // ms, same table
constexpr uint64_t kAcyclicTags = 0x1'0000;     // tags of acyclic objects: first_tag + this + variable

bool is_fast(int32_t cycle) { return cycle < 10; }

bool in_tens(int32_t value) { return value >= 0 && value <= kLongestCycle && value % 10 == 0; }

// Permitted cycle times: 1..9 ms (not on MOVITRAC 07) and 10..65530 ms in tens.
bool cycle_allowed(int32_t cycle, Generation generation) {
  if (cycle >= 1 && cycle <= 9) return generation != Generation::M07;
  return cycle >= 10 && in_tens(cycle);
}

// Permitted offsets: A p. 54 of 1053 1610; MOVITRAC 07 in tens; B p. 232 of IPOSplus, smaller than the cycle.
bool offset_allowed(int32_t offset, int32_t cycle, Generation generation) {
  if (generation == Generation::B) {
    if (offset >= cycle) return false;
    return is_fast(cycle) ? offset >= 0 && offset <= 8 : in_tens(offset);
  }
  return is_fast(cycle) ? offset >= 0 && offset <= kLongestFastOffset : in_tens(offset);
}

// The unit's own MOVILINK telegram with this identifier (1053 1610 p. 51): closed to its objects.
bool is_movilink_identifier(uint32_t id, const SlaveSettings& profile) {
  const auto used = classify_identifier(id);
  if (!used || !has_telegram(profile, used->telegram)) return false;
  return used->address == (telegram_type(used->telegram).grouped ? profile.group : profile.address);
}

constexpr uint32_t kReceiveFlags[] = {522, 523};  // of SBus 1 and 2, MOVIDRIVE B

}  // namespace

VariableObjects::VariableObjects(const stdlib::UnitType& unit, uint32_t baud, FrameSender& sender,
                                 uint64_t first_tag, int sbus)
    : unit_(unit), baud_(baud), sender_(sender), first_tag_(first_tag), sbus_(sbus) {}

bool VariableObjects::define(ObjectKind kind, uint32_t variable, std::span<int32_t> h, std::string& why) {
  const bool cyclic = kind == ObjectKind::TransmitCyclic;
  const auto element = [&](uint32_t n) -> int32_t& { return h[variable + n]; };
  const uint32_t at = cyclic ? 3 : 1;  // where length and pointer stand in the structure
  const int32_t bus_bit = sbus_ == 2 && element(0) >= 0 ? kSbus2Object : 0;
  const Header header{element(0) & ~bus_bit, element(at), element(at + 1)};
  int32_t* result = kind == ObjectKind::Receive ? nullptr : &element(cyclic ? 5 : 3);
  ObjectDefinition definition{kind,  variable, header.object, variable_format(header.format), 0, 0, 0,
                              false, {}};
  if (cyclic) {
    definition.cycle = element(1);
    definition.offset = element(2);
  }

  const auto format = definition.format;
  if (!format) {
    why = fmt::format("object {}: Format {:#x} is not 0..8 or 0x100..0x108; the object is not set up",
                      header.object, static_cast<uint32_t>(header.format));
  } else if (header.data < 0 || static_cast<uint32_t>(header.data) + format->variables() > unit_.variables) {
    return false;
  } else if (usable(header, why)) {
    definition.data = static_cast<uint32_t>(header.data);
    switch (kind) {
      case ObjectKind::TransmitCyclic:
        *result = define_cyclic(header, *format, element(1), element(2), why);
        definition.accepted = *result >= 0;
        break;
      case ObjectKind::TransmitAcyclic:
        send_acyclic(header, *format, variable, h);
        definition.accepted = true;
        break;
      case ObjectKind::Receive: definition.accepted = define_receive(header, *format, why); break;
    }
    if (definition.accepted && profile_.synchronous && header.object == profile_.sync_id)
      why = fmt::format("object number {} is also the sync telegram of this unit (P817 or P885)",
                        header.object);
    definition.why = why;
    remember(definition);
    return true;
  }
  // No manual prints a result for these; ours are those of a refused object.
  if (result != nullptr) *result = cyclic ? kWrongCycleTime : static_cast<int32_t>(AcyclicStatus::Failed);
  definition.why = why;
  remember(definition);
  return true;
}

void VariableObjects::remember(const ObjectDefinition& definition) {
  for (ObjectDefinition& known : definitions_) {
    if (known.kind != definition.kind || known.variable != definition.variable) continue;
    if (!known.accepted || definition.accepted) known = definition;
    return;
  }
  definitions_.push_back(definition);
}

bool VariableObjects::usable(const Header& header, std::string& why) const {
  if (header.object >= kSbus2Object && unit_.generation == Generation::B) {
    why = fmt::format("object {} is for SBus 2, which the station is not on; the object is not set up",
                      header.object & ~kSbus2Object);
    return false;
  }
  if (header.object < 0 || static_cast<uint32_t>(header.object) >= kStandardIdLimit) {
    why = fmt::format("object number {} is not 0..2047; the object is not set up", header.object);
    return false;
  }
  const auto id = static_cast<uint32_t>(header.object);
  if (is_movilink_identifier(id, profile_)) {
    why = fmt::format(
        "object number {} is an identifier of the unit's own MOVILINK telegrams; the object is not set up",
        id);
    return false;
  }
  return true;
}

int32_t VariableObjects::define_cyclic(const Header& header, VariableFormat format, int32_t cycle,
                                       int32_t offset, std::string& why) {
  const auto id = static_cast<uint32_t>(header.object);
  if (!cycle_allowed(cycle, unit_.generation)) {
    why = fmt::format("object {}: a cycle time of {} ms is not allowed; the object is not sent", id, cycle);
    return kWrongCycleTime;
  }
  if (!offset_allowed(offset, cycle, unit_.generation)) {
    why = fmt::format("object {}: an offset of {} ms is not allowed with {} ms; the object is not sent", id,
                      offset, cycle);
    return kWrongCycleTime;
  }
  const auto same = [id](const Cyclic& object) { return object.id == id; };
  if (std::any_of(cyclic_.begin(), cyclic_.end(), same)) {
    why = fmt::format("object {} is already sent by this unit; the second definition is not used", id);
    return kWrongCycleTime;
  }
  const auto of_class = std::count_if(cyclic_.begin(), cyclic_.end(), [&](const Cyclic& object) {
    return is_fast(object.cycle) == is_fast(cycle);
  });
  const int limit = is_fast(cycle) ? unit_.fast_objects : unit_.slow_objects;
  if (of_class >= limit) {
    why = fmt::format("object {}: the unit has only {} transmit objects of {}; the object is not sent", id,
                      limit, is_fast(cycle) ? "1 to 9 ms" : "10 ms and more");
    return kTooManyObjects;
  }
  const Cyclic object{
      id, cycle, offset, format, static_cast<uint32_t>(header.data), first_tag_ + cyclic_.size()};
  const int32_t free = free_capacity(object);
  if (free < 0) {
    why = fmt::format(
        "object {}: the cyclic objects of this unit would load the bus beyond 70 %; the object is not sent",
        id);
    return kBusOverload;
  }
  cyclic_.push_back(object);
  return free;
}

// The whole percent of the 70 % budget still free (docs/stdlib.md), negative when it is exceeded.
int32_t VariableObjects::free_capacity(const Cyclic& added) const {
  constexpr uint64_t kMicro = 1'000'000;  // loads are summed in millionths of a bit per second
  const auto load = [](const Cyclic& object) {
    return worst_case_bits(object.format.length, false) * 1000 * kMicro / static_cast<uint64_t>(object.cycle);
  };
  uint64_t used = load(added);
  for (const Cyclic& object : cyclic_) used += load(object);
  const uint64_t budget = uint64_t{baud_} * 70 / 100 * kMicro;
  return used > budget ? -1 : static_cast<int32_t>((budget - used) / (budget / 100));
}

bool VariableObjects::define_receive(const Header& header, VariableFormat format, std::string& why) {
  const auto id = static_cast<uint32_t>(header.object);
  const auto same = [id](const Receive& object) { return object.id == id; };
  if (receive_closed_) {
    why = fmt::format("receive object {} is defined after _SBusCommOn; it is not used", id);
    return false;
  }
  if (std::any_of(receive_.begin(), receive_.end(), same)) {
    why = fmt::format("object {} is already received by this unit; the second definition is not used", id);
    return false;
  }
  if (receive_.size() >= unit_.receive_objects) {
    why = fmt::format("receive object {}: the unit has only {} receive objects; it is not used", id,
                      unit_.receive_objects);
    return false;
  }
  receive_.push_back({id, format, static_cast<uint32_t>(header.data)});
  return true;
}

void VariableObjects::send_acyclic(const Header& header, VariableFormat format, uint32_t variable,
                                   std::span<int32_t> h) {
  const auto data = static_cast<uint32_t>(header.data);
  const VariablePair pair{format.variables() > 0 ? h[data] : 0, format.variables() > 1 ? h[data + 1] : 0};
  const Frame frame = variable_frame(static_cast<uint32_t>(header.object), format, pair);
  const bool queued = sender_.send(frame, first_tag_ + kAcyclicTags + variable) == SendStatus::Queued;
  h[variable + 3] = static_cast<int32_t>(queued ? AcyclicStatus::Sending : AcyclicStatus::Failed);
}

void VariableObjects::start(int64_t tick) {
  if (started_) return;
  started_ = true;
  receive_closed_ = true;
  start_tick_ = tick;
}

void VariableObjects::pause() {
  for (const Cyclic& object : cyclic_) sender_.withdraw(object.tag);
  started_ = false;
}

void VariableObjects::stop() {
  pause();
  receive_closed_ = false;
  cyclic_.clear();
  receive_.clear();
}

void VariableObjects::tick(int64_t tick, std::span<const int32_t> h) {
  if (!started_) return;
  for (const Cyclic& object : cyclic_) {
    const int64_t elapsed = tick - start_tick_ - object.offset;
    if (elapsed < 0 || elapsed % object.cycle != 0) continue;
    const VariablePair pair{object.format.variables() > 0 ? h[object.data] : 0,
                            object.format.variables() > 1 ? h[object.data + 1] : 0};
    // A telegram that is still waiting for the bus is overtaken by the new values.
    sender_.withdraw(object.tag);
    sender_.send(variable_frame(object.id, object.format, pair), object.tag);
  }
}

bool VariableObjects::on_frame(const Frame& frame, std::span<int32_t> h, std::string& why) const {
  if (!started_) return false;
  for (size_t n = 0; n < receive_.size(); ++n) {
    const Receive& object = receive_[n];
    if (object.id != frame.id || !is_plain(frame)) continue;
    const auto pair = frame_variables(frame, object.format);
    if (!pair) {
      why = fmt::format(
          "object {} came with {} bytes, its receive object has {}; its variables stay as they are", frame.id,
          frame.length, object.format.length);
      return false;
    }
    if (object.format.variables() > 0) h[object.data] = pair->low;
    if (object.format.variables() > 1) h[object.data + 1] = pair->high;
    if (unit_.generation == Generation::B) {
      int32_t& flags = h[kReceiveFlags[sbus_ - 1]];
      flags = static_cast<int32_t>(static_cast<uint32_t>(flags) | 1U << n);
    }
    return true;
  }
  return false;
}

void VariableObjects::on_sent(uint64_t tag, std::span<int32_t> h) {
  if (tag < first_tag_ + kAcyclicTags) return;
  h[tag - first_tag_ - kAcyclicTags + 3] = static_cast<int32_t>(AcyclicStatus::Sent);
}

void VariableObjects::on_not_sent(uint64_t tag, std::span<int32_t> h) {
  if (tag < first_tag_ + kAcyclicTags) return;
  sender_.withdraw(tag);
  h[tag - first_tag_ - kAcyclicTags + 3] = static_cast<int32_t>(AcyclicStatus::Failed);
}

}  // namespace ipos::runtime
