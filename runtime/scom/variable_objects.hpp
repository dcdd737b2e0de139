// The variable telegrams of one unit: what _SBusCommDef sets up and _SBusCommOn starts (1053 1610 p. 51 to
// 61). Time is an argument: tick() is called once a millisecond, after the tasks of the unit have run.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/bus/can/node.hpp"
#include "runtime/clock/event_queue.hpp"
#include "runtime/scom/object_table.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

// What one _SBusCommDef asked for, for tools: the last one of each structure.
struct ObjectDefinition {
  ObjectKind kind;
  uint32_t variable;  // of the structure
  int32_t object;     // as written, without the bit of SBus 2
  std::optional<VariableFormat> format;
  uint32_t data = 0;
  int32_t cycle = 0;  // ms
  int32_t offset = 0;
  bool accepted = false;
  std::string why;  // why not, or a warning
};

// The number of an object in a sentence: "44Ch (1100)" where it is an identifier.
std::string object_words(int32_t object);

// The objects of one SBus of a unit; the limits of the unit hold for each bus (ours: H522 and H523 have 32
// flags each).
class VariableObjects {
 public:
  // Frames are queued at `sender` with tags from first_tag on; baud is that of the line in bit/s. `sbus` is 1
  // or 2.
  VariableObjects(const stdlib::UnitType& unit, uint32_t baud, FrameSender& sender, uint64_t first_tag,
                  int sbus = 1);

  // The identifiers closed to the unit's objects are those of its MOVILINK profile (1053 1610 p. 51 to 53).
  void set_profile(const SlaveSettings& profile) { table_.set_profile(profile); }

  // SCOM: copies the structure that begins at `variable` and stores its result. An object that is refused is
  // not set up; `why` then says so. False: the data pointer names no variable of the unit (F10).
  bool define(ObjectKind kind, uint32_t variable, std::span<int32_t> h, std::string& why);

  void start(int64_t tick);  // SCOMON in this millisecond; nothing when it runs
  void pause();              // SCOMST STOP: nothing is sent or received, the objects stay (ours)
  void stop();               // program stop: nothing is sent or received any more, all objects are gone
  bool started() const { return table_.started(); }
  const std::vector<ObjectDefinition>& definitions() const { return definitions_; }
  const ObjectDefinition* object(uint32_t id) const;  // the one of this identifier that is set up

  // Queues the cyclic objects due in this millisecond with the present values of their variables. Returns the
  // next one in which it would; INT64_MAX for none.
  int64_t tick(int64_t tick, std::span<const int32_t> h) {
    if (tick >= due_) send_due(tick, h);
    return due_;
  }

  // Somebody else sends the cyclic objects, as their variables are now, until take_back(): leave(tag, frame, due, cycle) of
  // each, in milliseconds. After tick() of this one.
  size_t sending() const { return table_.sending(); }
  template <typename Leave>
  void leave(std::span<const int32_t> h, Leave leave) {
    for (size_t n = 0; n < table_.sending(); ++n)
      leave(static_cast<uint32_t>(first_tag_ + n), table_.frame(n, h), due_of_[n], uint32_t{table_.state().cyclic[n].cycle});
    due_ = INT64_MAX;
  }
  void take_back() { due_ = kUnknown; }

  // The receive object a frame is for, and whether its variables have the frame's values already.
  std::optional<size_t> receiver(const Frame& frame) const { return table_.receiver(frame); }
  template <typename Visit>
  void each_received(Visit visit) const {
    for (const ObjectTable::Receive& object :
         std::span(table_.state().receive).first(table_.state().receive_count))
      visit(uint32_t{object.id}, uint32_t{object.data}, object.format);
  }
  // The cyclic ones.
  template <typename Visit>
  void each_sent(Visit visit) const {
    for (const ObjectTable::Cyclic& object :
         std::span(table_.state().cyclic).first(table_.state().cyclic_count))
      visit(uint32_t{object.data}, object.format);
  }
  // True if the frame's length matches, so take() will succeed.
  bool fits(size_t receiver, const Frame& frame) const {
    return runtime::fits(frame, table_.state().receive[receiver].format);
  }
  void take(size_t receiver, const Frame& frame, std::span<int32_t> h) const {
    table_.take(receiver, frame, h);
  }
  // The first variable that a receive object writes.
  uint32_t data_of(size_t receiver) const { return table_.state().receive[receiver].data; }
  bool has_taken(size_t receiver, const Frame& frame, std::span<const int32_t> h) const {
    return table_.has_taken(receiver, frame, h);
  }
  // True when a receive object took the frame; `why` says why one did not.
  bool on_frame(const Frame& frame, std::span<int32_t> h, std::string& why) const;

  // For frames with a tag of this object; keeps the status of acyclic ones.
  void on_sent(uint64_t tag, std::span<int32_t> h);
  void on_not_sent(uint64_t tag, std::span<int32_t> h);

 private:
  static constexpr int64_t kUnknown = INT64_MIN;

  void send_due(int64_t tick, std::span<const int32_t> h);
  void forget_due();
  void remember(const ObjectDefinition& definition);
  const ObjectDefinition* another_use(const ObjectDefinition& definition) const;
  std::string reason(const ObjectRequest& request, ObjectVerdict verdict) const;

  int64_t due_ = kUnknown;  // before this millisecond nothing is
  FrameSender& sender_;
  uint64_t first_tag_;
  std::array<int64_t, ObjectTable::kMostCyclic> due_of_{};  // when each object is; known from the start on
  const stdlib::UnitType& unit_;
  ObjectTable table_;
  std::vector<ObjectDefinition> definitions_;
};

}  // namespace ipos::runtime
