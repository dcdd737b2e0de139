// Opens the adapter's channel, and tells answers from frames.
#include "runtime/os_port/slcan_client.hpp"

#include <fmt/format.h>

#include <utility>

namespace ipos::runtime {
namespace {

// What opens the channel, in order; the answers come in the same order.
constexpr std::string_view kOpening[] = {"close", "bit rate (S)", "time stamps (Z)", "open (O)"};
constexpr uint32_t kStampsAnswer = 2;

}  // namespace

SlcanClient::SlcanClient(std::string path, Tty tty, RealClock& clock)
    : name_("slcan:" + std::move(path)),
      tty_(std::move(tty)),
      clock_(clock),
      out_(kCanPortQueue * kLongestSlcanLine) {}

CanPortResult SlcanClient::open(std::string path, uint32_t serial_baud, uint32_t baud, RealClock& clock) {
  const auto rate = slcan_rate_digit(baud);
  if (!rate)
    return tl::unexpected(
        port_error(PortFault::NoBaudRate, path, fmt::format("slcan has none for {} bit/s", baud)));
  PortNotes notes;
  auto tty = Tty::open(path, {serial_baud, false, false}, notes);
  if (!tty) return tl::unexpected(tty.error());
  std::unique_ptr<SlcanClient> port(new SlcanClient(std::move(path), std::move(*tty), clock));
  port->out_.push(fmt::format("C\rS{}\rZ1\rO\r", *rate));
  if (const auto sent = port->flush(); !sent) return tl::unexpected(sent.error());
  return port;
}

SlcanClient::~SlcanClient() {
  out_.push("C\r");
  out_.write_by([this](std::string_view bytes) { return tty_.write(bytes); });
}

void SlcanClient::send(const Frame& frame) {
  if (!out_.push(slcan_text(frame))) {
    ++counts_.lost_out;
    notes_.note("frames are lost: the adapter does not take them as fast as they come");
    return;
  }
  ++counts_.sent;
  (void)flush();  // an error is seen by the loop's next flush
}

tl::expected<void, PortError> SlcanClient::flush() {
  if (const int error = out_.write_by([this](std::string_view bytes) { return tty_.write(bytes); });
      error != 0)
    return tl::unexpected(system_error(error, name_));
  if (!out_.empty()) ++counts_.waited;
  return {};
}

tl::expected<std::optional<CanArrival>, PortError> SlcanClient::receive() {
  for (;;) {
    if (input_at_ == input_end_) {
      // One reading, then the others have their turn: an adapter may send faster than we read.
      if (std::exchange(has_read_, false)) return std::nullopt;
      const auto size = tty_.read(input_);
      if (!size) return tl::unexpected(system_error(size.error(), name_));
      if (*size == 0) return std::nullopt;
      input_at_ = 0;
      input_end_ = *size;
      has_read_ = true;
    }
    const auto kind = lines_.push(input_[input_at_++]);
    if (!kind) continue;
    if (*kind == SlcanLines::Kind::Error) {
      take_refusal();
    } else if (*kind == SlcanLines::Kind::TooLong) {
      ++counts_.lost_in;
    } else if (auto arrival = take_line(lines_.line())) {
      return arrival;
    }
  }
}

// BEL: to one of the opening commands, or to a frame.
void SlcanClient::take_refusal() {
  if (answers_ >= std::size(kOpening)) {
    ++counts_.lost_out;
    notes_.note("the adapter refuses frames (BEL): its queue is full or its channel is closed");
    return;
  }
  const uint32_t which = answers_++;
  if (which == 0) return;  // the channel was closed already
  notes_.note(fmt::format("the adapter refuses {}{}", kOpening[which],
                          which == kStampsAnswer ? "; times are those of arrival here" : ""));
}

std::optional<CanArrival> SlcanClient::take_line(std::string_view line) {
  if (line.empty()) {
    if (answers_ < std::size(kOpening)) ++answers_;
    return std::nullopt;
  }
  if (line == "z" || line == "Z") return std::nullopt;  // a frame has been taken
  const auto parsed = parse_adapter_slcan(line);
  if (!parsed) {
    if (is_slcan_frame_letter(line[0]) || line[0] == 'x') {
      ++counts_.lost_in;
      notes_.count("a broken line from the adapter", line);
    }
    return std::nullopt;  // answers to V, N, F: not asked for
  }
  ++counts_.received;
  CanArrival arrival{clock_.now(), std::nullopt, std::nullopt, canonical(parsed->frame)};
  if (parsed->stamp) arrival.device_time = device_time(*parsed->stamp);
  return arrival;
}

// Stamps begin again every minute; after a longer silence whole minutes are missing.
Time SlcanClient::device_time(uint16_t stamp) {
  if (stamp < last_stamp_) stamp_base_ += kSlcanStampPeriod * kMillisecond;
  last_stamp_ = stamp;
  return stamp_base_ + stamp * kMillisecond;
}

}  // namespace ipos::runtime
