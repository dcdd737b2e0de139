// A CAN adapter with the LAWICEL protocol ("slcan") on a serial device.
#pragma once

#include <array>

#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/out_bytes.hpp"
#include "runtime/os_port/slcan_text.hpp"
#include "runtime/os_port/tty.hpp"

namespace ipos::runtime {

class SlcanClient final : public CanPort {
 public:
  // `baud` is the rate of the CAN bus, `serial_baud` that of the device. The channel is opened with stamps
  // on; answers are looked at as they come, as there are adapters that give none.
  static CanPortResult open(std::string path, uint32_t serial_baud, uint32_t baud, RealClock& clock);
  ~SlcanClient() override;

  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return {tty_.descriptor(), !out_.empty(), kNever}; }
  void send(const Frame& frame) override;
  tl::expected<std::optional<CanArrival>, PortError> receive() override;
  tl::expected<void, PortError> flush() override;
  size_t waiting() const override { return slcan_lines(out_.waiting()); }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return notes_.take(); }
  std::vector<std::string> repeats() const override { return notes_.repeats(); }

 private:
  SlcanClient(std::string path, Tty tty, RealClock& clock);

  void take_refusal();
  std::optional<CanArrival> take_line(std::string_view line);
  Time device_time(uint16_t stamp);

  std::string name_;
  Tty tty_;
  RealClock& clock_;
  OutBytes out_;
  SlcanLines lines_;
  std::array<char, 1024> input_;
  size_t input_at_ = 0;
  size_t input_end_ = 0;
  bool has_read_ = false;    // since receive() said last that there is nothing
  uint32_t answers_ = 0;     // to the commands that open the channel
  Time stamp_base_ = 0;      // full minutes of the adapter's clock
  uint16_t last_stamp_ = 0;  // ms
  PortCounts counts_;
  PortNotes notes_;
};

}  // namespace ipos::runtime
