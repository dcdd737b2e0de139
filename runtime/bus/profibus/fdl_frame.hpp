// The frames of PROFIBUS layer 2 (FDL, EN 50170 volume 2): five formats told apart by their first octet.
// Between fields and octets in both directions; what a strict receiver drops is named by a FrameError.
//
//   SD1  10 DA SA FC FCS 16                                    no data
//   SD2  68 LE LE 68 DA SA FC [DSAP] [SSAP] data FCS 16        LE = 3 + access points + data, 4..249
//   SD3  A2 DA SA FC [DSAP] [SSAP] data FCS 16                 access points and data are 8 octets
//   SD4  DC DA SA                                              token
//   SC   E5                                                    short acknowledgement
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <tl/expected.hpp>

#include "runtime/bus/profibus/octets/octets.hpp"

namespace ipos::profibus {

enum class Delimiter : uint8_t { SD1 = 0x10, SD2 = 0x68, SD3 = 0xA2, SD4 = 0xDC, SC = 0xE5 };
inline constexpr uint8_t kEndDelimiter = 0x16;

inline constexpr uint8_t kLastStation = 125;
inline constexpr uint8_t kNoAddressYet = 126;
inline constexpr uint8_t kBroadcast = 127;

inline constexpr uint8_t kShortestLength = 4;  // of LE
inline constexpr uint8_t kLongestLength = 249;

enum class FdlRequest : uint8_t {
#define FDL_REQUEST(name, code, text) name = code,
#include "runtime/bus/profibus/fdl_functions.def"
};
enum class FdlAnswer : uint8_t {
#define FDL_ANSWER(name, code, text) name = code,
#include "runtime/bus/profibus/fdl_functions.def"
};

// What a station is, in bits 4 and 5 of an answer.
enum class StationKind : uint8_t { Slave, MasterNotReady, MasterReady, MasterInRing };

namespace control {
inline constexpr uint8_t kRequest = 0x40;
inline constexpr uint8_t kFrameCount = 0x20;       // FCB: alternates, so that a repetition is known as one
inline constexpr uint8_t kFrameCountValid = 0x10;  // FCV
inline constexpr uint8_t kFunctionMask = 0x0F;
}  // namespace control

enum class FrameError : uint8_t {
#define FRAME_ERROR(name, text) name,
#include "runtime/bus/profibus/frame_errors.def"
};
std::string_view frame_error_text(FrameError error);
std::optional<FrameError> frame_error(std::string_view text);  // of that text

struct FdlFrame {
  Delimiter kind = Delimiter::SC;
  uint8_t destination = 0;
  uint8_t source = 0;
  uint8_t control = 0;          // FC
  std::optional<uint8_t> dsap;  // 0..63
  std::optional<uint8_t> ssap;
  Octets data;

  bool is_token() const { return kind == Delimiter::SD4; }
  bool is_acknowledgement() const { return kind == Delimiter::SC; }
  bool has_control() const { return !is_token() && !is_acknowledgement(); }
  bool is_request() const { return has_control() && (control & control::kRequest) != 0; }
  bool is_answer() const { return is_acknowledgement() || (has_control() && !is_request()); }
  bool frame_count() const { return (control & control::kFrameCount) != 0; }
  bool frame_count_valid() const { return (control & control::kFrameCountValid) != 0; }
  uint8_t function() const { return control & control::kFunctionMask; }
  bool asks(FdlRequest request) const { return is_request() && function() == static_cast<uint8_t>(request); }
  bool answers(FdlAnswer answer) const {
    return has_control() && !is_request() && function() == static_cast<uint8_t>(answer);
  }
  StationKind station() const { return static_cast<StationKind>(control >> 4 & 3); }
  // Requests and tokens want 33 idle bits before them, answers 11.
  bool needs_idle() const { return is_token() || is_request(); }

  friend bool operator==(const FdlFrame&, const FdlFrame&) = default;
};

// SD1 where there is neither access point nor data, else SD2.
FdlFrame make_frame(uint8_t destination, uint8_t source, uint8_t control, std::optional<uint8_t> dsap = {},
                    std::optional<uint8_t> ssap = {}, Octets data = {});
FdlFrame make_token(uint8_t destination, uint8_t source);
inline FdlFrame make_acknowledgement() { return {}; }

// The fields must fit the format: see above.
Octets encode(const FdlFrame& frame);

// The whole frame, no octet more or less.
tl::expected<FdlFrame, FrameError> decode(std::span<const uint8_t> octets);

// How long the frame is that begins so; nothing while that is still open. Begins with no known delimiter, or
// a head that no frame has: an error.
tl::expected<std::optional<size_t>, FrameError> frame_size(std::span<const uint8_t> begin);

// Sum of the octets, mod 256.
uint8_t frame_check(std::span<const uint8_t> octets);

}  // namespace ipos::profibus
