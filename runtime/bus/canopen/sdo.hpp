// The bytes of the service data channel (CiA 301; page 55 of 11264926): command, index low byte first,
// sub-index, four bytes of data, low byte first.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/bus/canopen/abort.hpp"
#include "runtime/bus/canopen/object_dictionary.hpp"

namespace ipos::runtime::canopen {

using SdoBytes = std::array<uint8_t, 8>;

namespace sdo {

// Upper three bits of byte 0: what a client asks, and what a server answers.
enum class Ask : uint8_t {
  DownloadSegment,
  Download,
  Upload,
  UploadSegment,
  Abort,
  BlockUpload,
  BlockDownload,
  None
};
enum class Answer : uint8_t {
  UploadSegment,
  DownloadSegment,
  Upload,
  Download,
  Abort,
  BlockDownload,
  BlockUpload,
  None
};
constexpr Ask ask_of(const SdoBytes& bytes) { return static_cast<Ask>(bytes[0] >> 5); }
constexpr Answer answer_of(const SdoBytes& bytes) { return static_cast<Answer>(bytes[0] >> 5); }
template <typename Command>
constexpr uint8_t command(Command code, unsigned flags = 0) {
  return static_cast<uint8_t>(static_cast<unsigned>(code) << 5 | flags);
}

inline constexpr uint8_t kToggle = 0x10;     // of a segment
inline constexpr uint8_t kLast = 0x01;       // the last segment
inline constexpr uint8_t kExpedited = 0x02;  // of an initiate: the data are in it
inline constexpr uint8_t kSized = 0x01;      // of an initiate: the length is told
inline constexpr size_t kSegment = 7;        // bytes of data

constexpr uint8_t unused_of_four(uint8_t byte0) { return byte0 >> 2 & 3; }
constexpr uint8_t unused_of_seven(uint8_t byte0) { return byte0 >> 1 & 7; }

constexpr Address address_of(const SdoBytes& bytes) {
  return {static_cast<uint16_t>(bytes[1] | bytes[2] << 8), bytes[3]};
}
constexpr uint32_t data_of(const SdoBytes& bytes) {
  return bytes[4] | uint32_t{bytes[5]} << 8 | uint32_t{bytes[6]} << 16 | uint32_t{bytes[7]} << 24;
}
constexpr SdoBytes initiate(uint8_t byte0, Address address, uint32_t data = 0) {
  return {byte0,
          static_cast<uint8_t>(address.index),
          static_cast<uint8_t>(address.index >> 8),
          address.sub,
          static_cast<uint8_t>(data),
          static_cast<uint8_t>(data >> 8),
          static_cast<uint8_t>(data >> 16),
          static_cast<uint8_t>(data >> 24)};
}
// The same byte both ways.
constexpr SdoBytes abort(Address address, Abort code) {
  return initiate(command(Ask::Abort), address, static_cast<uint32_t>(code));
}

// The next segment of what is left to be sent: seven bytes, or the last ones.
template <typename Command>
constexpr SdoBytes segment(Command code, uint8_t toggle, std::span<const uint8_t> left) {
  const size_t length = std::min(kSegment, left.size());
  const unsigned last = length == left.size() ? kLast : 0U;
  SdoBytes bytes = {command(code, toggle | static_cast<unsigned>(kSegment - length) << 1 | last)};
  std::copy_n(left.begin(), length, bytes.begin() + 1);
  return bytes;
}

}  // namespace sdo
}  // namespace ipos::runtime::canopen
