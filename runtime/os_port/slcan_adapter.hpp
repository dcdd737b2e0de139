// The adapter's end of slcan on a pseudo-terminal: slcand, python-can and others attach to a simulated bus as
// they would to a CAN adapter.
#pragma once

#include <array>

#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/pty.hpp"
#include "runtime/os_port/slcan_text.hpp"

namespace ipos::runtime {

class SlcanAdapter final : public CanPort {
 public:
  static CanPortResult open(const std::string& path, uint32_t baud, RealClock& clock);

  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return pty_.needs(); }
  void send(const Frame& frame) override;
  tl::expected<std::optional<CanArrival>, PortError> receive() override;
  tl::expected<void, PortError> flush() override;
  std::string_view absence() const override { return pty_.absence(); }
  size_t waiting() const override { return slcan_lines(pty_.waiting()); }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return notes_.take(); }
  std::vector<std::string> repeats() const override { return notes_.repeats(); }

  bool is_channel_open() const { return channel_ != Channel::Closed; }

 private:
  enum class Channel : uint8_t { Closed, Open, ListenOnly };

  SlcanAdapter(Pty pty, uint32_t baud, RealClock& clock)
      : name_("slcan:pty:" + pty.path()), pty_(std::move(pty)), baud_(baud), clock_(clock) {}

  // A frame to put on the bus, or nothing: then the command has been answered.
  std::optional<Frame> execute(std::string_view command);
  bool set_up(std::string_view command);
  bool open_channel(Channel channel);
  void detach();

  std::string name_;
  Pty pty_;
  uint32_t baud_;
  RealClock& clock_;
  Channel channel_ = Channel::Closed;
  bool stamps_ = false;
  bool overrun_ = false;          // since the last F
  uint32_t asked_baud_ = 0;       // by S; 0: the program has not said
  std::array<char, 1024> input_;  // read, not looked at yet
  size_t input_at_ = 0;
  size_t input_end_ = 0;
  bool has_read_ = false;  // since receive() said last that there is nothing
  SlcanLines lines_;
  PortCounts counts_;
  PortNotes notes_;
};

}  // namespace ipos::runtime
