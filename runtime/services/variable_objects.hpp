// The variable telegrams of one unit: what _SBusCommDef sets up and _SBusCommOn starts (1053 1610 p. 51 to
// 61). Time is an argument: tick() is called once a millisecond, after the tasks of the unit have run.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/bus/can/node.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"
#include "runtime/clock/event_queue.hpp"
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

class VariableObjects {
 public:
  // Frames are queued at `sender` with tags from first_tag on; baud is that of the line in bit/s.
  VariableObjects(const stdlib::UnitType& unit, uint32_t baud, FrameSender& sender, uint64_t first_tag);

  // The identifiers closed to the unit's objects follow from its addresses (1053 1610 p. 51 to 53).
  void set_addresses(uint8_t address, uint8_t group);

  // SCOM: copies the structure that begins at `variable` and stores its result. An object that is refused is
  // not set up; `why` then says so. False: the data pointer names no variable of the unit (F10).
  bool define(ObjectKind kind, uint32_t variable, std::span<int32_t> h, std::string& why);

  void start(int64_t tick);  // SCOMON in this millisecond
  void stop();               // program stop: nothing is sent or received any more, all objects are gone
  bool started() const { return started_; }

  // Queues the cyclic objects due in this millisecond with the present values of their variables.
  void tick(int64_t tick, std::span<const int32_t> h);

  // True when a receive object took the frame; `why` says why one did not.
  bool on_frame(const Frame& frame, std::span<int32_t> h, std::string& why) const;

  // For frames with a tag of this object; keeps the status of acyclic ones.
  void on_sent(uint64_t tag, std::span<int32_t> h);
  void on_not_sent(uint64_t tag, std::span<int32_t> h);

 private:
  struct Cyclic {
    uint32_t id;
    int32_t cycle;   // ms
    int32_t offset;  // ms after the start
    VariableFormat format;
    uint32_t data;  // number of the first variable
    uint64_t tag;
  };
  struct Receive {
    uint32_t id;
    VariableFormat format;
    uint32_t data;
  };
  struct Header {
    int32_t object;
    int32_t format;
    int32_t data;
  };

  int32_t define_cyclic(const Header& header, VariableFormat format, int32_t cycle, int32_t offset,
                        std::string& why);
  void define_receive(const Header& header, VariableFormat format, std::string& why);
  void send_acyclic(const Header& header, VariableFormat format, uint32_t variable, std::span<int32_t> h);
  bool usable(const Header& header, std::string& why) const;
  int32_t free_capacity(const Cyclic& added) const;

  const stdlib::UnitType& unit_;
  uint32_t baud_;
  FrameSender& sender_;
  uint64_t first_tag_;
  uint8_t address_ = 0;
  uint8_t group_ = 0;
  bool started_ = false;
  int64_t start_tick_ = 0;
  std::vector<Cyclic> cyclic_;
  std::vector<Receive> receive_;
};

}  // namespace ipos::runtime
