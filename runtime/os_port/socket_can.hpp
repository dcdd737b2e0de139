// A SocketCAN interface through a raw socket (Documentation/networking/can.rst of Linux).
#pragma once

#include <deque>

#include "runtime/os_port/can_link.hpp"
#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/descriptor.hpp"

namespace ipos::runtime {

class SocketCan final : public CanPort {
 public:
  static CanPortResult open(std::string name, uint32_t baud, RealClock& clock);

  const std::string& name() const override { return name_; }
  PortNeeds needs() const override;
  void send(const Frame& frame) override;
  tl::expected<std::optional<CanArrival>, PortError> receive() override;
  tl::expected<void, PortError> flush() override;
  std::string_view absence() const override { return down_ ? "the interface is down" : std::string_view(); }
  size_t waiting() const override { return queue_.size(); }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return notes_.take(); }

 private:
  SocketCan(std::string name, Descriptor descriptor, RealClock& clock)
      : name_(std::move(name)), descriptor_(std::move(descriptor)), clock_(clock) {}

  Time host_time(Time stamp);
  void drop_all(const char* why);
  void go_down();
  tl::expected<void, PortError> look_whether_up();

  std::string name_;
  Descriptor descriptor_;
  RealClock& clock_;
  std::deque<Frame> queue_;
  Time retry_ = kNever;  // the system had no room
  bool down_ = false;
  Time look_again_ = 0;  // whether it is up
  Time last_arrival_ = 0;
  uint32_t overruns_ = 0;  // as the kernel counts them
  PortCounts counts_;
  PortNotes notes_;
};

}  // namespace ipos::runtime
