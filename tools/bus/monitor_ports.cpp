// The monitor at real ports.
#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <optional>

#include "runtime/bus/profibus/timing.hpp"
#include "runtime/bus/rs485/timing.hpp"
#include "runtime/os_port/adapter_port.hpp"
#include "runtime/os_port/can_port.hpp"
#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "runtime/os_port/system_clock.hpp"
#include "tools/bus/monitor_sources.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

// A signal may come just before the wait, and a pseudo-terminal with nobody attached cannot be polled (ours).
constexpr Time kLongestWait = 20 * runtime::kMillisecond;

// So much is taken before Ctrl-C, --for and the screen have their turn (ours).
constexpr int kFramesALook = 1024, kReadsALook = 16;

// Host time as candump logs write it. The offset is taken once, so that times do not jump with the clock.
class Stamps {
 public:
  explicit Stamps(runtime::RealClock& clock) {
    // Both clocks are read one after the other: the try with the least time in between counts.
    Time least = runtime::kNever;
    for (int tries = 0; tries < 16; ++tries) {
      const Time before = clock.now();
      const Time wall = clock.wall();
      const Time took = clock.now() - before;
      if (took >= least) continue;
      least = took;
      offset_ = wall - before - runtime::kCandumpEpoch;
    }
  }
  Time of(Time host) const { return host + offset_; }

 private:
  Time offset_ = 0;
};

// Bytes of a port to telegrams. Bytes read in one go stand without the pauses that were between them, so a
// start character right after a complete telegram begins the next one (ours).
class SerialListener {
 public:
  SerialListener(Monitor& monitor, const std::string& name, uint32_t baud)
      : monitor_(monitor), name_(name), character_(runtime::character_time(baud)) {}

  void take(const runtime::ByteArrival& byte, const Stamps& stamps) {
    const bool start = byte.value == runtime::kRequestStart || byte.value == runtime::kResponseStart;
    if (complete_ && start) shift_ += runtime::kStartPause + character_;
    complete_ = false;
    // The driver does not say whether it was parity or frame.
    show(receiver_.take({byte.at - character_ + shift_, byte.at + shift_, byte.value, byte.bad, false}),
         stamps);
  }

  // What is under way may be over.
  void look(Time now, const Stamps& stamps) {
    if (now + shift_ - kLongestWait > receiver_.deadline()) show(receiver_.give_up(), stamps);
  }

 private:
  void show(const std::optional<runtime::Reception>& reception, const Stamps& stamps) {
    if (!reception) return;
    complete_ = reception->telegram.has_value();
    monitor_.take(stamps.of(reception->start - shift_), name_, *reception);
  }

  Monitor& monitor_;
  const std::string& name_;
  Time character_;
  runtime::SerialReceiver receiver_;
  Time shift_ = 0;  // pauses put in
  bool complete_ = false;
};

// Calls `read` until it says that the port has gone, and tells what the port has to say.
template <typename Port, typename Read>
int watch(Monitor& monitor, Port& port, runtime::RealClock& clock, Time duration, const char* unit,
          Read read) {
  const Stamps stamps(clock);
  const Time begin = clock.now();
  const Time end = duration == runtime::kNever ? runtime::kNever : begin + duration;
  uint64_t lost = 0;
  std::optional<runtime::PortError> gone;
  const auto over = [&] { return interrupted() || monitor.full() || clock.now() >= end; };
  fmt::print(stderr, "ipos: monitoring {}\n", port.name());
  while (!gone && !over()) {
    gone = read(stamps);
    if (const uint64_t now_lost = port.counts().lost_in; now_lost != lost) {
      monitor.lost(stamps.of(clock.now()), port.name(), now_lost - lost, unit);
      lost = now_lost;
    }
    if (const auto flushed = port.flush(); !flushed && !gone) gone = flushed.error();
    for (const std::string& text : port.take_notes()) monitor.note(port.name() + ": " + text);
    monitor.flush();
    if (gone || over()) break;
    const std::array<runtime::PortNeeds, 1> needs{port.needs()};
    clock.wait(std::min(clock.now() + kLongestWait, end), needs);
  }
  for (const std::string& text : port.repeats()) monitor.note(port.name() + ": " + text);
  monitor.finish();
  if (gone) throw Failure(kIoError, gone->text);
  return interrupted() ? kInterrupted : kGood;
}

}  // namespace

MonitorSource monitor_source(const std::string& name) {
  namespace fs = std::filesystem;
  if (name == "-" || name == "/dev/stdin") return MonitorSource::Log;
  std::error_code ignored;
  const fs::file_status status = fs::status(name, ignored);
  const bool is_there = fs::exists(status) || fs::is_symlink(fs::symlink_status(name, ignored));
  if (is_there && !fs::is_character_file(status)) return MonitorSource::Log;
  if (name.starts_with("pty:")) return MonitorSource::Serial;
  if (runtime::kind_of_port(name) == runtime::PortKind::Serial) {
    if (runtime::is_device(name)) return MonitorSource::Serial;
  } else if (name.find('.') == std::string::npos || name.starts_with("slcan:") || runtime::is_adapter_port(name)) {
    return MonitorSource::Can;
  }
  throw Failure(kNoInput, fmt::format("{}: there is no such log and no such device", name));
}

int monitor_can(Monitor& monitor, const std::string& name, uint32_t baud, Time duration) {
  runtime::SystemClock clock;
  const runtime::CanPortResult port = runtime::open_can_port(name, baud, clock);
  if (!port) throw Failure(kIoError, port.error().text);
  return watch(monitor, **port, clock, duration, "frames", [&](const Stamps& stamps) {
    for (int n = 0; n < kFramesALook && !monitor.full(); ++n) {
      const auto got = (*port)->receive();
      if (!got) return std::optional(got.error());
      if (!*got) break;
      const runtime::CanArrival& arrival = **got;
      if (arrival.error)
        monitor.bus_error(stamps.of(arrival.at), name, runtime::describe(*arrival.error));
      else
        monitor.take({stamps.of(arrival.at), name, arrival.frame});
    }
    return std::optional<runtime::PortError>();
  });
}

int monitor_serial(Monitor& monitor, const std::string& name, uint32_t baud, Time duration) {
  runtime::SystemClock clock;
  const runtime::SerialPortResult port = runtime::open_serial_port(name, {baud, true}, clock);
  if (!port) throw Failure(kIoError, port.error().text);
  SerialListener listener(monitor, name, baud);
  return watch(monitor, **port, clock, duration, "bytes", [&](const Stamps& stamps) {
    std::array<runtime::ByteArrival, 512> bytes{};
    for (int n = 0; n < kReadsALook; ++n) {
      const auto count = (*port)->receive(bytes);
      if (!count) return std::optional(count.error());
      if (*count == 0) break;
      for (const runtime::ByteArrival& byte : std::span(bytes).first(*count)) listener.take(byte, stamps);
    }
    listener.look(clock.now(), stamps);
    return std::optional<runtime::PortError>();
  });
}

int monitor_profibus(Monitor& monitor, const std::string& name, uint32_t baud, Time duration) {
  runtime::SystemClock clock;
  const runtime::SerialPortResult port = runtime::open_serial_port(name, {baud, true, false}, clock);
  if (!port) throw Failure(kIoError, port.error().text);
  profibus::FdlReceiver receiver(profibus::kPortLimits);
  const Time width = static_cast<Time>(profibus::kCharacterBits) * runtime::kSecond / baud;
  return watch(monitor, **port, clock, duration, "octets", [&](const Stamps& stamps) {
    std::array<runtime::ByteArrival, 512> bytes{};
    for (int n = 0; n < kReadsALook; ++n) {
      const auto count = (*port)->receive(bytes);
      if (!count) return std::optional(count.error());
      if (*count == 0) break;
      for (const runtime::ByteArrival& byte : std::span(bytes).first(*count))
        for (const profibus::Reception& heard :
             receiver.take({byte.at - width, byte.at, byte.value, byte.bad, false}))
          monitor.take(stamps.of(heard.start), name, heard);
    }
    return std::optional<runtime::PortError>();
  });
}

}  // namespace ipos::tools
