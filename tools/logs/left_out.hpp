// What readers of logs leave out on purpose: records that are no frames of classic CAN, RS-485 or PROFIBUS. They are counted
// in one place for all forms, and told once at the end.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace ipos::tools {

enum class LeftOut : uint8_t {
  ErrorFrame,
  FdFrame,          // CAN FD and CAN XL
  TransmitRequest,  // an order to a controller: the frame itself follows in the log
  Record,           // status of a controller, statistics, events of other buses
  OtherPacket,      // of a line that is no bus, for example Ethernet
  CutPacket,        // captured in part only
  UntimedPacket,
  OtherBus,  // understood, but not what the verb is for
  Line,      // not understood, and told as an error
};
inline constexpr size_t kLeftOutKinds = 9;

class LeftOutCounts {
 public:
  void add(LeftOut what) { ++counts_[static_cast<size_t>(what)]; }
  uint64_t of(LeftOut what) const { return counts_[static_cast<size_t>(what)]; }
  uint64_t total() const;
  // "12 error frames, 1 line not understood"; empty where nothing was left out.
  std::string text() const;

 private:
  std::array<uint64_t, kLeftOutKinds> counts_{};
};

}  // namespace ipos::tools
