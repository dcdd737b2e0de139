// Numbers little endian, but the identifier of SocketCAN, which its link type wants big endian.
#include "tools/logs/writing/pcapng_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/log/candump.hpp"

namespace ipos::tools {
namespace {

using pcapng::LinkType;

template <typename T>
std::string number(T value) {
  std::string bytes;
  for (size_t n = 0; n < sizeof value; ++n) bytes += static_cast<char>(value >> 8 * n & 0xFF);
  return bytes;
}

void fill(std::string& bytes) { bytes.resize((bytes.size() + 3) / 4 * 4); }

std::string option(uint16_t code, const std::string& value) {
  std::string bytes = number(code) + number(static_cast<uint16_t>(value.size())) + value;
  fill(bytes);
  return bytes;
}
std::string end_of_options() { return number(pcapng::kEndOfOptions) + number(uint16_t{0}); }

}  // namespace

PcapngWriter::PcapngWriter(std::ostream& out, const LogPart& part) : out_(out), announces_(part.begins) {
  if (part.begins)
    block(pcapng::kSection,
          number(pcapng::kByteOrder) + number(uint16_t{1}) + number(uint16_t{0}) + number(UINT64_MAX));
  for (const LogPart::Line& line : part.lines)
    interface_of(line.name, line.kind == LineKind::Can      ? LinkType::SocketCan
                            : line.kind == LineKind::Serial ? LinkType::User0Serial
                                                            : LinkType::User1Dp);
  announces_ = true;
}

void PcapngWriter::can(runtime::Time time, const std::string& bus, const runtime::Frame& frame) {
  const uint32_t word =
      frame.id | (frame.extended ? pcapng::kExtended : 0) | (frame.remote ? pcapng::kRemote : 0);
  std::array<uint8_t, 16> bytes{};
  for (unsigned n = 0; n < 4; ++n) bytes[n] = static_cast<uint8_t>(word >> (24 - 8 * n));
  bytes[4] = frame.length;
  const size_t length = frame.remote ? 0 : frame.length;
  std::copy_n(frame.data.begin(), length, bytes.begin() + 8);
  packet(time, bus, LinkType::SocketCan, std::span(bytes).first(8 + length));
}

// Eight bytes without a detail (linux/can/error.h).
void PcapngWriter::can_error(const runtime::CanLine& line, const runtime::ErrorRecord& error) {
  constexpr uint32_t kAcknowledge = 0x20, kProtocol = 0x08, kBusError = 0x80;
  const uint32_t word = pcapng::kError | (error.unacknowledged ? kAcknowledge : kProtocol | kBusError);
  std::array<uint8_t, 16> bytes{};
  for (unsigned n = 0; n < 4; ++n) bytes[n] = static_cast<uint8_t>(word >> (24 - 8 * n));
  bytes[4] = 8;
  packet(error.end, line.name(), LinkType::SocketCan, bytes);
}

void PcapngWriter::serial(const std::string& line, const runtime::Reception& reception) {
  packet(
      reception.start, line, LinkType::User0Serial, reception.bytes.span(),
      reception.telegram ? "" : pcapng::kVoid + std::string(serial_error_text(reception.telegram.error())));
}

void PcapngWriter::dp(const std::string& line, const profibus::Reception& reception) {
  packet(reception.start, line, LinkType::User1Dp, reception.octets,
         reception.frame ? "" : pcapng::kVoid + std::string(frame_error_text(reception.frame.error())));
}

void PcapngWriter::packet(runtime::Time time, const std::string& bus, LinkType link,
                          std::span<const uint8_t> bytes, const std::string& comment) {
  const uint32_t on = interface_of(bus, link);
  const auto stamp = static_cast<uint64_t>(time + runtime::kCandumpEpoch);
  const auto size = static_cast<uint32_t>(bytes.size());
  std::string body = number(on) + number(static_cast<uint32_t>(stamp >> 32)) +
                     number(static_cast<uint32_t>(stamp)) + number(size) + number(size) +
                     std::string(bytes.begin(), bytes.end());
  fill(body);
  if (!comment.empty()) body += option(pcapng::kComment, comment) + end_of_options();
  block(pcapng::kPacket, body);
}

uint32_t PcapngWriter::interface_of(const std::string& bus, LinkType link) {
  const auto found = std::find(interfaces_.begin(), interfaces_.end(), std::pair(bus, link));
  if (found != interfaces_.end()) return static_cast<uint32_t>(found - interfaces_.begin());
  constexpr char kNanosecond = 9;
  if (announces_)
    block(pcapng::kInterface, number(static_cast<uint16_t>(link)) + number(uint16_t{0}) + number(uint32_t{0}) +
                                  option(pcapng::kName, bus) +
                                  option(pcapng::kResolution, std::string(1, kNanosecond)) + end_of_options());
  interfaces_.emplace_back(bus, link);
  return static_cast<uint32_t>(interfaces_.size() - 1);
}

void PcapngWriter::block(uint32_t type, const std::string& body) {
  const std::string size = number(static_cast<uint32_t>(body.size() + 12));
  out_ << number(type) << size << body << size;
}

}  // namespace ipos::tools
