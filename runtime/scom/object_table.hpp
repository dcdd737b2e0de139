// The variable telegrams of one SBus of a unit as data: what _SBusCommDef sets up and what is due when (1053
// 1610 p. 51 to 61). No heap, no text, no bus: the simulated station (variable_objects) and the library for
// firmware (embed) both use it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/bus/movilink/profile.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

// Result of SCTRCYCL (1053 1610 p. 54); 0..100 is the free bus capacity in percent.
inline constexpr int32_t kWrongCycleTime = -1;
inline constexpr int32_t kTooManyObjects = -2;
inline constexpr int32_t kBusOverload = -3;

// Status of SCTRACYCL (1053 1610 p. 56).
enum class AcyclicStatus : int32_t { Ready = 0, Sending = 1, Sent = 2, Failed = 3 };

// First argument of _SBusCommDef; the values of the keyword set `scom`.
enum class ObjectKind : int32_t { TransmitCyclic = 1, TransmitAcyclic = 2, Receive = 3 };

// Bit 24 of the object number selects SBus 2 of a MOVIDRIVE B (IPOSplus p. 232).
inline constexpr int32_t kSbus2Object = 0x100'0000;

// Why an object was not set up, in the order in which it is looked for.
enum class ObjectVerdict : uint8_t {
  Accepted,
  NoVariables,       // the data pointer names no variables of the unit: F10
  NoFormat,          // not 0..8 or 100h..108h
  OnSbus2,           // for a bus the unit is not on
  NoIdentifier,      // not 0..2047
  ClosedIdentifier,  // one of the unit's own MOVILINK telegrams (1053 1610 p. 51)
  WrongCycleTime,
  WrongOffset,
  SentTwice,
  SentAndReceived,  // by one unit (1053 1610 p. 51, rule 2)
  TooManyTransmit,
  Overload,  // beyond 70 % of the bus
  TooLate,   // a receive object after _SBusCommOn
  ReceivedTwice,
  TooManyReceive,
};

// The elements of the structure a definition is made of.
struct ObjectRequest {
  ObjectKind kind;
  int32_t object = 0;  // as written, without the bit of SBus 2
  int32_t cycle = 0;   // ms
  int32_t offset = 0;
  int32_t format = 0;
  int32_t data = 0;
  uint32_t result = 0;  // number of the variable for the result; none for receive objects
};

class ObjectTable {
 public:
  struct Cyclic {
    uint16_t id = 0;
    uint16_t cycle = 0;   // ms
    uint16_t offset = 0;  // ms after the start
    uint16_t data = 0;    // number of the first variable
    VariableFormat format;
  };
  struct Receive {
    uint16_t id = 0;
    uint16_t data = 0;
    VariableFormat format;
  };
  static constexpr size_t kMostCyclic = [] {
    std::array<size_t, 256> of_family{};
#define SBUS_OBJECTS(family, shortest, longest, step, objects, ...) \
  of_family[static_cast<size_t>(stdlib::Family::family)] += (objects);
#include "stdlib/unit_families.def"
    return *std::max_element(of_family.begin(), of_family.end());
  }();
  static constexpr size_t kMostReceive = 32;  // 1053 1610 p. 55

  // Everything that changes; plain values.
  struct State {
    std::array<Cyclic, kMostCyclic> cyclic{};
    std::array<Receive, kMostReceive> receive{};
    uint8_t cyclic_count = 0;
    uint8_t receive_count = 0;
    bool started = false;
    bool closed = false;  // no receive objects after the first start
    int64_t start_tick = 0;
  };

  // Tags of frames: the number of the cyclic object, or this and the variable of the acyclic structure.
  static constexpr uint32_t kAcyclicTags = 0x1'0000;

  // baud is that of the line in bit/s. `sbus` is 1 or 2.
  ObjectTable(const stdlib::UnitType& unit, uint32_t baud, int sbus)
      : unit_(&unit), baud_(baud), sbus_(sbus) {}

  // The identifiers closed to the unit's objects are those of its MOVILINK profile (1053 1610 p. 51 to 53).
  void set_profile(const SlaveSettings& profile) { profile_ = profile; }
  const stdlib::UnitType& unit() const { return *unit_; }
  const SlaveSettings& profile() const { return profile_; }

  ObjectRequest request(ObjectKind kind, uint32_t variable, std::span<const int32_t> h) const;

  // SCOM: sets the object up and stores the result, except for an accepted acyclic one: its frame is to
  // be sent and the status set by note_acyclic().
  ObjectVerdict define(const ObjectRequest& request, std::span<int32_t> h);
  static Frame acyclic_frame(const ObjectRequest& request, std::span<const int32_t> h);
  // For a tag of an acyclic object; others are left alone.
  static void note_acyclic(uint32_t tag, AcyclicStatus status, std::span<int32_t> h);

  void start(int64_t tick);                 // SCOMON in this millisecond; nothing when it runs
  void pause() { state_.started = false; }  // SCOMST STOP: the objects stay (ours)
  void stop() { state_ = {}; }              // program stop: all objects are gone
  bool started() const { return state_.started; }

  // send(tag, frame) for each cyclic object due in this millisecond.
  template <class Send>
  void due(int64_t tick, std::span<const int32_t> h, Send send) const {
    if (!state_.started) return;
    for (uint32_t n = 0; n < state_.cyclic_count; ++n) {
      const Cyclic& object = state_.cyclic[n];
      const int64_t elapsed = tick - state_.start_tick - object.offset;
      if (elapsed >= 0 && elapsed % object.cycle == 0)
        send(n, object_frame(object.id, object.format, object.data, h));
    }
  }

  // The same object by object: so many are sent, when the n-th is due after `tick`, and its frame.
  size_t sending() const { return state_.started ? state_.cyclic_count : 0; }
  int64_t next_due(size_t n, int64_t tick) const;
  Frame frame(size_t n, std::span<const int32_t> h) const {
    const Cyclic& object = state_.cyclic[n];
    return object_frame(object.id, object.format, object.data, h);
  }

  // The receive object a frame is for; nothing when there is none.
  std::optional<size_t> receiver(const Frame& frame) const;
  // Its variables take the frame's values; false when the length is another one. MOVIDRIVE B sets bit n of
  // H522 (SBus 1) or H523 (SBus 2) for its n-th receive object; the program clears it (order and clearing
  // ours; IPOSplus p. 232).
  bool take(size_t receiver, const Frame& frame, std::span<int32_t> h) const;
  // take() would take it and leave the variables as they are.
  bool has_taken(size_t receiver, const Frame& frame, std::span<const int32_t> h) const;

  const State& state() const { return state_; }
  // A state that was saved; false, and nothing changes, when it cannot be one of this unit.
  bool restore(const State& state);

 private:
  static Frame object_frame(uint32_t id, const VariableFormat& format, uint32_t data,
                            std::span<const int32_t> h) {
    return variable_frame(id, format,
                          {format.variables() > 0 ? h[data] : 0, format.variables() > 1 ? h[data + 1] : 0});
  }
  ObjectVerdict judge(const ObjectRequest& request) const;
  ObjectVerdict define_cyclic(const ObjectRequest& request, int32_t& result);
  ObjectVerdict define_receive(const ObjectRequest& request);
  bool sends(int32_t object) const;
  bool receives(int32_t object) const;
  int32_t free_capacity(const Cyclic& added) const;
  bool is_sound(uint32_t id, VariableFormat format, uint32_t data) const;

  const stdlib::UnitType* unit_;
  uint32_t baud_;
  int sbus_;
  SlaveSettings profile_;
  State state_;
};

}  // namespace ipos::runtime
