// The 8 bytes of the MOVILINK parameter channel, the same on every interface (1053 1610 p. 29-31, 42-44):
// management, reserved or subindex, index high, index low, data from the most significant byte down.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/bus/movilink/return_code.hpp"
#include "stdlib/services.hpp"

namespace ipos::runtime {

using stdlib::is_write;
using stdlib::Service;
using stdlib::service_from_code;
using stdlib::service_text;

// Bits of the management byte.
namespace management {
inline constexpr uint8_t kServiceMask = 0x0F;
inline constexpr uint8_t kLengthMask = 0x30;
inline constexpr uint8_t kFourBytes = 0x30;
inline constexpr uint8_t kHandshake = 0x40;  // on SBus: answer after the next sync telegram (p. 43)
inline constexpr uint8_t kFailed = 0x80;
}  // namespace management

struct ParameterTelegram {
  uint8_t management = 0;
  uint8_t subindex = 0;  // reserved on units without subindices, always sent as 0 there
  uint16_t index = 0;
  uint32_t data = 0;

  constexpr uint8_t service_code() const { return management & management::kServiceMask; }
  // Of the data of a write: 1 to 4 bytes. SEW units always use 4.
  constexpr uint8_t data_length() const {
    return static_cast<uint8_t>(((management & management::kLengthMask) >> 4) + 1);
  }
  constexpr bool synchronous() const { return (management & management::kHandshake) != 0; }
  constexpr bool failed() const { return (management & management::kFailed) != 0; }
  constexpr ReturnCode return_code() const { return ReturnCode::unpack(data); }  // when failed()
  friend bool operator==(const ParameterTelegram&, const ParameterTelegram&) = default;
};

using ParameterBytes = std::array<uint8_t, 8>;

ParameterBytes encode(const ParameterTelegram& telegram);
ParameterTelegram decode_parameter(const ParameterBytes& bytes);

// A request with length code 4 bytes; a read carries no data.
ParameterTelegram parameter_request(Service service, uint16_t index, uint8_t subindex, int32_t value);

// Answers repeat service, handshake bit, subindex and index, and always carry length code 4 bytes (ours).
ParameterTelegram parameter_response(const ParameterTelegram& request, int32_t value);
ParameterTelegram parameter_refusal(const ParameterTelegram& request, ReturnCode code);

}  // namespace ipos::runtime
