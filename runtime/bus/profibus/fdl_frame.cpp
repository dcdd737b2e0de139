// Coding of the five formats. The head of SD2 is checked as soon as it is there, so that a receiver does not
// wait for octets that a damaged length promises.
#include "runtime/bus/profibus/fdl_frame.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <utility>

namespace ipos::profibus {
namespace {

constexpr uint8_t kHasAccessPoint = 0x80;  // of DA and SA
constexpr uint8_t kAddressMask = 0x7F;
constexpr uint8_t kLastAccessPoint = 63;
constexpr size_t kFixedData = 8;  // of SD3
constexpr size_t kHeadSize = 4;   // of SD2

constexpr std::string_view kErrorTexts[] = {
#define FRAME_ERROR(name, text) text,
#include "runtime/bus/profibus/frame_errors.def"
};

// Octets before DA.
size_t head_size(Delimiter kind) { return kind == Delimiter::SD2 ? kHeadSize : 1; }

// DA SA FC and what follows up to the check octet. Longer address extensions and segment addresses exist in
// the norm, but no DP station has them: the frame is not valid.
tl::expected<FdlFrame, FrameError> decode_body(Delimiter kind, std::span<const uint8_t> body) {
  FdlFrame frame;
  frame.kind = kind;
  frame.destination = body[0] & kAddressMask;
  frame.source = body[1] & kAddressMask;
  frame.control = body[2];
  size_t at = 3;
  const auto take_access_point = [&](uint8_t address, std::optional<uint8_t>& point) {
    if ((address & kHasAccessPoint) == 0) return true;
    if (at == body.size() || body[at] > kLastAccessPoint) return false;
    point = body[at++];
    return true;
  };
  if (frame.source > kNoAddressYet || !take_access_point(body[0], frame.dsap) ||
      !take_access_point(body[1], frame.ssap))
    return tl::unexpected(FrameError::Address);
  frame.data.assign(body.begin() + static_cast<long>(at), body.end());
  return frame;
}

tl::expected<FdlFrame, FrameError> decode_token(std::span<const uint8_t> octets) {
  if (octets[1] > kNoAddressYet || octets[2] > kNoAddressYet) return tl::unexpected(FrameError::Address);
  return make_token(octets[1], octets[2]);
}

}  // namespace

std::string_view frame_error_text(FrameError error) { return kErrorTexts[static_cast<size_t>(error)]; }

std::optional<FrameError> frame_error(std::string_view text) {
  const auto found = std::find(std::begin(kErrorTexts), std::end(kErrorTexts), text);
  if (found == std::end(kErrorTexts)) return std::nullopt;
  return static_cast<FrameError>(found - std::begin(kErrorTexts));
}

uint8_t frame_check(std::span<const uint8_t> octets) {
  return static_cast<uint8_t>(std::accumulate(octets.begin(), octets.end(), 0U));
}

FdlFrame make_frame(uint8_t destination, uint8_t source, uint8_t control, std::optional<uint8_t> dsap,
                    std::optional<uint8_t> ssap, Octets data) {
  const bool empty = !dsap && !ssap && data.empty();
  return {empty ? Delimiter::SD1 : Delimiter::SD2, destination, source, control, dsap, ssap, std::move(data)};
}

FdlFrame make_token(uint8_t destination, uint8_t source) {
  FdlFrame token;
  token.kind = Delimiter::SD4;
  token.destination = destination;
  token.source = source;
  return token;
}

Octets encode(const FdlFrame& frame) {
  const uint8_t start = static_cast<uint8_t>(frame.kind);
  if (frame.is_acknowledgement()) return {start};
  if (frame.is_token()) return {start, frame.destination, frame.source};
  Octets octets{start};
  if (frame.kind == Delimiter::SD2) {
    const size_t length = 3 + frame.dsap.has_value() + frame.ssap.has_value() + frame.data.size();
    octets = {start, static_cast<uint8_t>(length), static_cast<uint8_t>(length), start};
  }
  const size_t body = octets.size();
  octets.push_back(static_cast<uint8_t>(frame.destination | (frame.dsap ? kHasAccessPoint : 0)));
  octets.push_back(static_cast<uint8_t>(frame.source | (frame.ssap ? kHasAccessPoint : 0)));
  octets.push_back(frame.control);
  if (frame.dsap) octets.push_back(*frame.dsap);
  if (frame.ssap) octets.push_back(*frame.ssap);
  octets.insert(octets.end(), frame.data.begin(), frame.data.end());
  octets.push_back(frame_check(std::span(octets).subspan(body)));
  octets.push_back(kEndDelimiter);
  return octets;
}

tl::expected<std::optional<size_t>, FrameError> frame_size(std::span<const uint8_t> begin) {
  if (begin.empty()) return std::nullopt;
  switch (static_cast<Delimiter>(begin[0])) {
    case Delimiter::SC: return 1;
    case Delimiter::SD4: return 3;
    case Delimiter::SD1: return 6;
    case Delimiter::SD3: return 6 + kFixedData;
    case Delimiter::SD2: break;
    default: return tl::unexpected(FrameError::Start);
  }
  if (begin.size() > 1 && (begin[1] < kShortestLength || begin[1] > kLongestLength))
    return tl::unexpected(FrameError::Length);
  if (begin.size() > 2 && begin[1] != begin[2]) return tl::unexpected(FrameError::LengthTwice);
  if (begin.size() > 3 && begin[3] != begin[0]) return tl::unexpected(FrameError::SecondStart);
  if (begin.size() < kHeadSize) return std::nullopt;
  return kHeadSize + begin[1] + 2;
}

tl::expected<FdlFrame, FrameError> decode(std::span<const uint8_t> octets) {
  const auto size = frame_size(octets);
  if (!size) return tl::unexpected(size.error());
  if (!*size || octets.size() != **size) return tl::unexpected(FrameError::Size);
  const auto kind = static_cast<Delimiter>(octets[0]);
  if (kind == Delimiter::SC) return make_acknowledgement();
  if (kind == Delimiter::SD4) return decode_token(octets);
  const size_t head = head_size(kind);
  const auto body = octets.subspan(head, octets.size() - head - 2);
  if (octets.back() != kEndDelimiter) return tl::unexpected(FrameError::End);
  if (octets[octets.size() - 2] != frame_check(body)) return tl::unexpected(FrameError::Check);
  return decode_body(kind, body);
}

}  // namespace ipos::profibus
