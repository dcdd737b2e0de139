// The serial device, and from names to both kinds of serial port.
#include "runtime/os_port/serial_port.hpp"

#include <array>
#include <charconv>

#include "runtime/os_port/out_bytes.hpp"
#include "runtime/os_port/parity_marks.hpp"
#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/pty_port.hpp"
#include "runtime/os_port/tty.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kReadSize = 512;

std::string_view as_text(std::span<const uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class Device final : public BytePort {
 public:
  Device(std::string name, Time latency, Tty tty, const SerialSettings& settings, RealClock& clock,
         PortNotes notes)
      : name_(std::move(name)),
        latency_(latency),
        tty_(std::move(tty)),
        clock_(clock),
        // start bit, 8 data bits, parity bit, stop bit
        character_time_((settings.even_parity ? 11 : 10) * kSecond / settings.baud),
        out_(kSerialPortQueue),
        notes_(std::move(notes)) {}

  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return {tty_.descriptor(), !out_.empty(), kNever}; }
  bool has_parity() const override { return tty_.has_parity(); }
  bool paces() const override { return true; }
  Time latency() const override { return latency_; }
  size_t waiting() const override { return out_.waiting().size(); }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return notes_.take(); }

  void send(std::span<const uint8_t> bytes) override {
    if (!out_.push(as_text(bytes))) {
      counts_.lost_out += bytes.size();
      notes_.note("bytes are lost: the device does not send them as fast as they come");
      return;
    }
    counts_.sent += bytes.size();
    (void)flush();  // an error is seen by the loop's next flush
  }

  tl::expected<void, PortError> flush() override {
    const int error = out_.write_by([this](std::string_view bytes) { return tty_.write(bytes); });
    if (error != 0) return tl::unexpected(system_error(error, name_));
    if (!out_.empty()) ++counts_.waited;
    return {};
  }

  tl::expected<size_t, PortError> receive(std::span<ByteArrival> into) override {
    std::array<char, kReadSize> raw{};
    const auto size = tty_.read(std::span(raw).first(std::min(raw.size(), into.size())));
    if (!size) return tl::unexpected(system_error(size.error(), name_));
    size_t count = 0;
    for (size_t n = 0; n < *size; ++n) {
      const auto byte = static_cast<uint8_t>(raw[n]);
      const auto taken = tty_.marks_errors() ? marks_.push(byte) : MarkedByte{byte, false};
      if (taken) into[count++] = {0, taken->value, taken->bad};
    }
    const Time now = clock_.now();
    for (size_t n = 0; n < count; ++n) {
      const Time at = now - static_cast<Time>(count - 1 - n) * character_time_;
      into[n].at = last_ = std::max(last_, at);
    }
    counts_.received += count;
    return count;
  }

 private:
  std::string name_;
  Time latency_;
  Tty tty_;
  RealClock& clock_;
  Time character_time_;
  OutBytes out_;
  ParityMarks marks_;
  Time last_ = 0;
  PortCounts counts_;
  PortNotes notes_;
};

// "/dev/ttyUSB0@16ms": path and latency; nothing when what stands after the @ is no number of milliseconds.
struct DeviceName {
  std::string path;
  Time latency = 0;
};
std::optional<DeviceName> parse_device(std::string_view name) {
  const size_t at = name.rfind('@');
  if (at == std::string_view::npos) return DeviceName{std::string(name)};
  constexpr uint32_t kLongest = 1000;
  const std::string_view text = name.substr(at + 1);
  uint32_t ms = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), ms);
  const std::string_view rest = text.substr(static_cast<size_t>(end - text.data()));
  if (status != std::errc() || rest != "ms" || ms > kLongest) return std::nullopt;
  return DeviceName{std::string(name.substr(0, at)), ms * kMillisecond};
}

}  // namespace

SerialPortResult open_serial_port(std::string_view name, const SerialSettings& settings, RealClock& clock) {
  if (settings.movilink && settings.baud != 9600 && settings.baud != 57600)
    return tl::unexpected(port_error(PortFault::NoBaudRate, name, "MOVILINK has 9600 and 57600 bit/s"));
  if (name.starts_with(kPtyPort)) return open_pty_port(name, settings, clock);
  const auto device = parse_device(name);
  if (!device || !is_path(device->path))
    return tl::unexpected(port_error(PortFault::BadName, name, kPortNames));
  PortNotes notes;
  auto tty = Tty::open(device->path, {settings.baud, settings.even_parity, true}, notes);
  if (!tty) return tl::unexpected(tty.error());
  return std::make_unique<Device>(std::string(name), device->latency, std::move(*tty), settings, clock,
                                  std::move(notes));
}

}  // namespace ipos::runtime
