// Frames out and in, one question at a time.
#include "tools/links/dp_station.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/bus/profibus/timing.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"

namespace ipos::tools {
namespace {

using namespace profibus;  // NOLINT: all of this is about its frames
using runtime::kMillisecond;
using runtime::Time;

// All of these are ours. A master passes the token within milliseconds, also to itself; a lost one is claimed after
// (6 + 2 x 125) slot times at most, of 100 bits at 9.6 kbaud 2.7 s, but then nobody is there to be disturbed.
constexpr Time kListen = 300 * kMillisecond;
// A slave gives up a rate after 100 ms of errors, and there are six.
constexpr Time kWake = 700 * kMillisecond, kWakeEvery = 5 * kMillisecond;
constexpr int kServiceTries = 3, kStatusTries = 2;
constexpr size_t kLongestFrame = 255;

uint8_t code(FdlAnswer answer) { return static_cast<uint8_t>(answer); }

}  // namespace

DpStation::DpStation(const LinkFlags& flags) : flags_(flags) {
  catch_interrupts();
  constexpr uint32_t kBaud = 500'000;
  if (flags_.baud == 0) flags_.baud = kBaud;
  if (find_baud_rate(flags_.baud) == nullptr)
    throw Failure(
        kUsage,
        fmt::format("--baud {}: PROFIBUS has 9600, 19200, 93750, 187500, 500000 and 1500000", flags_.baud));
  auto port = runtime::open_serial_port(flags_.port, {flags_.baud, true, false}, clock_);
  if (!port) throw Failure(kIoError, port.error().text);
  port_ = std::move(*port);
  tell();
  refuse_other_masters();
  wake_slaves();
}

void DpStation::tell() {
  for (const std::string& text : port_->take_notes())
    if (!flags_.quiet) fmt::print(stderr, "ipos: {}: {}\n", flags_.port, text);
}

Time DpStation::wire_time(size_t octets) const {
  return static_cast<Time>(octets * profibus::kCharacterBits) * runtime::kSecond / flags_.baud;
}

void DpStation::refuse_other_masters() {
  const Time end = clock_.now() + kListen + port_->latency();
  while (const auto frame = receive(end)) {
    if (!frame->is_token() && !frame->is_request()) continue;
    throw Failure(kIoError,
                  fmt::format("{}: master {} speaks on the line: two masters share a line by a token, whose "
                              "times a PC does not keep; stop it first, or watch with 'ipos bus monitor'",
                              flags_.port, frame->source));
  }
}

// To itself: nobody answers, and everybody hears the rate.
void DpStation::wake_slaves() {
  const Time end = clock_.now() + kWake;
  while (clock_.now() < end) {
    send(make_frame(kPcAddress, kPcAddress, control::kRequest | static_cast<uint8_t>(FdlRequest::FdlStatus)));
    (void)receive(clock_.now() + std::max(kWakeEvery, 2 * wire_time(8)));
  }
}

void DpStation::send(const FdlFrame& frame) {
  port_->send(encode(frame));
  if (const auto flushed = port_->flush(); !flushed) throw Failure(kIoError, flushed.error().text);
}

std::optional<FdlFrame> DpStation::receive(Time end) {
  for (;;) {
    if (interrupted()) throw Failure(kInterrupted, "");
    std::array<runtime::ByteArrival, 256> bytes{};
    const auto count = port_->receive(bytes);
    if (!count) throw Failure(kIoError, count.error().text);
    for (const runtime::ByteArrival& byte : std::span(bytes).first(*count)) {
      runtime::Character character;
      character.start = byte.at - wire_time(1);
      character.end = byte.at;
      character.data = byte.value;
      character.parity_error = byte.bad;
      for (profibus::Reception& reception : receiver_.take(character))
        if (reception.frame) heard_.push_back(std::move(*reception.frame));
    }
    if (!heard_.empty()) {
      FdlFrame first = std::move(heard_.front());
      heard_.erase(heard_.begin());
      return first;
    }
    if (*count != 0) continue;
    if (clock_.now() >= end) return std::nullopt;
    const std::array<runtime::PortNeeds, 1> needs{port_->needs()};
    clock_.wait(end, needs);
    if (const auto flushed = port_->flush(); !flushed) throw Failure(kIoError, flushed.error().text);
  }
}

// Frames take their time on the wire, and once more on the line of a simulated slave behind a pseudo-terminal.
std::optional<FdlFrame> DpStation::ask(const FdlFrame& request, size_t longest_answer, int tries) {
  const Time patience =
      flags_.host_delay() + port_->latency() + 2 * wire_time(encode(request).size() + longest_answer + kSynBits);
  for (int n = 0; n < tries; ++n) {
    while (receive(0)) continue;  // late answers
    send(request);
    const Time end = clock_.now() + patience;
    while (auto answer = receive(end)) {
      if (answer->is_acknowledgement()) return answer;
      if (answer->is_answer() && answer->source == request.destination && answer->destination == kPcAddress &&
          (!answer->dsap || (answer->dsap == request.ssap && answer->ssap == request.dsap)))
        return answer;
    }
  }
  return std::nullopt;
}

std::optional<StationKind> DpStation::status(uint8_t address) {
  const auto answer =
      ask(make_frame(address, kPcAddress, control::kRequest | static_cast<uint8_t>(FdlRequest::FdlStatus)), 6,
          kStatusTries);
  if (!answer || !answer->has_control()) return std::nullopt;
  return answer->station();
}

// The frame count bit changes with each answer, so that a repetition is known as one.
DpReply DpStation::request(uint8_t address, std::optional<uint8_t> point, std::optional<uint8_t> own_point, Octets data) {
  auto& bit = frame_count_[address];
  const uint8_t counted =
      bit ? control::kFrameCountValid | (*bit ? control::kFrameCount : 0) : control::kFrameCount;
  const auto answer = ask(make_frame(address, kPcAddress,
                                     static_cast<uint8_t>(control::kRequest | counted |
                                                          static_cast<uint8_t>(FdlRequest::SrdHigh)),
                                     point, own_point, std::move(data)),
                          kLongestFrame, kServiceTries);
  if (!answer) {
    bit.reset();
    return {};
  }
  bit = bit ? !*bit : false;
  if (answer->is_acknowledgement()) return {true, false, {}};
  const uint8_t function = answer->function();
  const bool data_came = function == code(FdlAnswer::DataLow) || function == code(FdlAnswer::DataHigh);
  return {true, !data_came, answer->data};
}

DpReply DpStation::service(uint8_t address, DpService service, Octets data) {
  return request(address, static_cast<uint8_t>(service), kMasterAccessPoint, std::move(data));
}

DpReply DpStation::exchange(uint8_t address, Octets outputs) {
  return request(address, std::nullopt, std::nullopt, std::move(outputs));
}

DpReply DpStation::fms(uint8_t address, uint8_t point, Octets data) {
  return request(address, point, point, std::move(data));
}

}  // namespace ipos::tools
