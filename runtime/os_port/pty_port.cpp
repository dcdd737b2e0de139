// A pseudo-terminal as a serial line.
#include "runtime/os_port/pty_port.hpp"

#include <algorithm>
#include <array>

#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/pty.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kPtyReadSize = 512;

class PseudoTerminal final : public BytePort {
 public:
  PseudoTerminal(std::string name, Pty pty, bool even_parity, RealClock& clock)
      : name_(std::move(name)), pty_(std::move(pty)), clock_(clock) {
    if (even_parity) notes_.note("a pseudo-terminal has no parity: only the block check is left");
  }

  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return pty_.needs(); }
  std::string_view absence() const override { return pty_.absence(); }
  bool has_parity() const override { return false; }
  bool paces() const override { return false; }
  Time latency() const override { return 0; }
  size_t waiting() const override { return pty_.waiting().size(); }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return notes_.take(); }

  void send(std::span<const uint8_t> bytes) override {
    if (pty_.write({reinterpret_cast<const char*>(bytes.data()), bytes.size()})) {
      counts_.sent += bytes.size();
      return;
    }
    counts_.lost_out += bytes.size();
    notes_.note("bytes are lost: the program at the other end does not read them");
  }

  tl::expected<void, PortError> flush() override {
    pty_.flush();
    return {};
  }

  tl::expected<size_t, PortError> receive(std::span<ByteArrival> into) override {
    std::array<char, kPtyReadSize> raw{};
    const size_t size = pty_.read(std::span(raw).first(std::min(raw.size(), into.size())));
    const Time now = clock_.now();
    for (size_t n = 0; n < size; ++n) into[n] = {now, static_cast<uint8_t>(raw[n]), false};
    counts_.received += size;
    return size;
  }

 private:
  std::string name_;
  Pty pty_;
  RealClock& clock_;
  PortCounts counts_;
  PortNotes notes_;
};

}  // namespace

SerialPortResult open_pty_port(std::string_view name, const SerialSettings& settings, RealClock& clock) {
  auto pty = Pty::create(std::string(name.substr(kPtyPort.size())), kSerialPortQueue);
  if (!pty) return tl::unexpected(pty.error());
  return std::make_unique<PseudoTerminal>(std::string(name), std::move(*pty), settings.even_parity, clock);
}

}  // namespace ipos::runtime
