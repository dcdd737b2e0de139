// Commands of the LAWICEL protocol as an adapter with automatic sending (X1) answers them. Commands that
// would change what a program receives and are not there (filters, polling) are refused with BEL, never
// ignored.
#include "runtime/os_port/slcan_adapter.hpp"

#include <fmt/format.h>

#include <utility>

namespace ipos::runtime {
namespace {

constexpr std::string_view kVersion = "V0101\r";  // hardware and software 1 (ours)
constexpr std::string_view kSerial = "NIPOS\r";   // ours
constexpr uint8_t kDataOverrun = 0x08;            // status flag bit 3

bool is_hex(char c) { return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'F') || (c >= 'a' && c <= 'f'); }

}  // namespace

CanPortResult SlcanAdapter::open(const std::string& path, uint32_t baud, RealClock& clock) {
  auto pty = Pty::create(path, kCanPortQueue * kLongestSlcanLine);
  if (!pty) return tl::unexpected(pty.error());
  return std::unique_ptr<CanPort>(new SlcanAdapter(std::move(*pty), baud, clock));
}

void SlcanAdapter::send(const Frame& frame) {
  if (channel_ == Channel::Closed) return;  // as an adapter off the bus
  const auto stamp = static_cast<uint16_t>(clock_.now() / kMillisecond % kSlcanStampPeriod);
  if (pty_.write(slcan_text(frame, stamps_ ? std::optional(stamp) : std::nullopt))) {
    ++counts_.sent;
    return;
  }
  ++counts_.lost_out;
  overrun_ = true;
  notes_.note("frames are lost: the program at the other end does not read them");
}

tl::expected<void, PortError> SlcanAdapter::flush() {
  pty_.flush();
  return {};
}

tl::expected<std::optional<CanArrival>, PortError> SlcanAdapter::receive() {
  for (;;) {
    if (input_at_ == input_end_) {
      // One reading, then the others have their turn: a program may write faster than we read.
      if (std::exchange(has_read_, false)) return std::nullopt;
      input_at_ = 0;
      input_end_ = pty_.read(input_);
      if (input_end_ == 0) {
        if (!pty_.is_attached()) detach();
        return std::nullopt;
      }
      has_read_ = true;
    }
    const auto kind = lines_.push(input_[input_at_++]);
    if (!kind) continue;
    if (*kind != SlcanLines::Kind::Line) {
      ++counts_.lost_in;
      pty_.write({&kSlcanError, 1});
      continue;
    }
    const std::optional<Frame> frame = execute(lines_.line());
    if (!frame) continue;
    ++counts_.received;
    return CanArrival{clock_.now(), std::nullopt, std::nullopt, *frame};
  }
}

std::optional<Frame> SlcanAdapter::execute(std::string_view command) {
  if (command.empty()) {  // programs send CR to clear the adapter's input
    pty_.write({&kSlcanOk, 1});
    return std::nullopt;
  }
  if (is_slcan_frame_letter(command[0])) {
    const auto parsed = parse_slcan(command);
    if (channel_ != Channel::Open || !parsed || parsed->stamp) {
      if (channel_ == Channel::Open) {
        ++counts_.lost_in;
        notes_.count("a line that is no frame is refused", command);
      }
      pty_.write({&kSlcanError, 1});
      return std::nullopt;
    }
    pty_.write(parsed->frame.extended ? "Z\r" : "z\r");
    return canonical(parsed->frame);
  }
  if (command == "V") {
    pty_.write(kVersion);
  } else if (command == "N") {
    pty_.write(kSerial);
  } else if (command == "F" && channel_ != Channel::Closed) {
    pty_.write(fmt::format("F{:02X}\r", overrun_ ? kDataOverrun : 0));
    overrun_ = false;
  } else {
    const bool done = set_up(command);
    const char answer = done ? kSlcanOk : kSlcanError;
    pty_.write({&answer, 1});
  }
  return std::nullopt;
}

// Commands answered with CR or BEL alone.
bool SlcanAdapter::set_up(std::string_view command) {
  const bool closed = channel_ == Channel::Closed;
  if (command == "O") return open_channel(Channel::Open);
  if (command == "L") return open_channel(Channel::ListenOnly);
  if (command == "C") {
    channel_ = Channel::Closed;
    return true;  // also when it was closed: programs begin with it (ours)
  }
  if (command == "X1") return true;
  if (command == "Z0" || command == "Z1") {
    if (closed) stamps_ = command == "Z1";
    return closed;
  }
  if (command.size() == 2 && command[0] == 'S' && command[1] >= '0' && command[1] <= '8') {
    if (closed) asked_baud_ = kSlcanRates[static_cast<size_t>(command[1] - '0')];
    return closed;
  }
  // Bit timing registers: a rate of the program's own, which we cannot compare.
  if (command.size() == 5 && command[0] == 's' && std::all_of(command.begin() + 1, command.end(), is_hex)) {
    if (closed) asked_baud_ = 0;
    return closed;
  }
  return false;
}

// A program with the wrong bit rate would hear nothing on a real bus; here opening is refused, and we say why
// (ours).
bool SlcanAdapter::open_channel(Channel channel) {
  if (channel_ != Channel::Closed) return false;
  if (asked_baud_ != 0 && asked_baud_ != baud_) {
    notes_.note(
        fmt::format("refused to open: the program asks for {} bit/s, the bus has {}", asked_baud_, baud_));
    return false;
  }
  channel_ = channel;
  return true;
}

void SlcanAdapter::detach() {
  channel_ = Channel::Closed;
  stamps_ = false;
  asked_baud_ = 0;
  lines_.clear();
}

}  // namespace ipos::runtime
