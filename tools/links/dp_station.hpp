// A PC on a PROFIBUS line, at a real port: a master outside of the ring that asks one station at a time. It begins only
// where no other master speaks, as a PC cannot keep the times of a token ring.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "runtime/bus/profibus/dp_service.hpp"
#include "runtime/bus/profibus/fdl_receiver.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tools/links/bus_link.hpp"

namespace ipos::tools {

inline constexpr uint8_t kPcAddress = 0;  // as programming devices have it (ours)

// What came back from a slave: data, or a short acknowledgement without; else a reason of layer 2.
struct DpReply {
  bool answered = false;
  bool refused = false;  // RS, or another negative answer
  profibus::Octets data;
};

class DpStation {
 public:
  // Opens the port, listens for other masters, and lets the slaves find the rate. A Failure says why it cannot be.
  explicit DpStation(const LinkFlags& flags);

  // What a station is; nothing from nobody.
  std::optional<profibus::StationKind> status(uint8_t address);
  DpReply service(uint8_t address, profibus::DpService service, profibus::Octets data = {});
  DpReply exchange(uint8_t address, profibus::Octets outputs);
  DpReply fms(uint8_t address, uint8_t point, profibus::Octets data);  // on a connection

  runtime::Time now() { return clock_.now(); }
  const std::string& port_name() const { return flags_.port; }
  uint32_t baud() const { return flags_.baud; }
  bool heard_anything() const { return port_->counts().received != 0; }

 private:
  using Octets = profibus::Octets;
  using FdlFrame = profibus::FdlFrame;

  void send(const FdlFrame& frame);
  // The next frame without error; nothing by `end`.
  std::optional<FdlFrame> receive(runtime::Time end);
  std::optional<FdlFrame> ask(const FdlFrame& request, size_t longest_answer, int tries);
  DpReply request(uint8_t address, std::optional<uint8_t> point, std::optional<uint8_t> own_point, Octets data);
  runtime::Time wire_time(size_t octets) const;
  void refuse_other_masters();
  void wake_slaves();
  void tell();

  LinkFlags flags_;
  runtime::SystemClock clock_;
  std::unique_ptr<runtime::BytePort> port_;
  profibus::FdlReceiver receiver_{profibus::kPortLimits};
  std::vector<FdlFrame> heard_;  // and not taken yet
  // Of the next request to each address: nothing begins a sequence.
  std::array<std::optional<bool>, profibus::kBroadcast> frame_count_;
};

}  // namespace ipos::tools
