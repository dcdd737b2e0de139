// Codec of the parameter channel.
#include "runtime/bus/movilink/parameter_telegram.hpp"

namespace ipos::runtime {

ParameterBytes encode(const ParameterTelegram& t) {
  const auto byte = [](uint32_t value, unsigned shift) { return static_cast<uint8_t>(value >> shift); };
  return {t.management,     t.subindex,       byte(t.index, 8), byte(t.index, 0),
          byte(t.data, 24), byte(t.data, 16), byte(t.data, 8),  byte(t.data, 0)};
}

ParameterTelegram decode_parameter(const ParameterBytes& b) {
  ParameterTelegram t;
  t.management = b[0];
  t.subindex = b[1];
  t.index = static_cast<uint16_t>(b[2] << 8 | b[3]);
  t.data = uint32_t{b[4]} << 24 | uint32_t{b[5]} << 16 | uint32_t{b[6]} << 8 | uint32_t{b[7]};
  return t;
}

ParameterTelegram parameter_request(Service service, uint16_t index, uint8_t subindex, int32_t value) {
  ParameterTelegram request;
  request.management = static_cast<uint8_t>(management::kFourBytes | static_cast<uint8_t>(service));
  request.subindex = subindex;
  request.index = index;
  request.data = is_write(service) ? static_cast<uint32_t>(value) : 0;
  return request;
}

ParameterTelegram parameter_response(const ParameterTelegram& request, int32_t value) {
  constexpr uint8_t kRepeated = management::kServiceMask | management::kHandshake;
  ParameterTelegram response = request;
  response.management = static_cast<uint8_t>((request.management & kRepeated) | management::kFourBytes);
  response.data = static_cast<uint32_t>(value);
  return response;
}

ParameterTelegram parameter_refusal(const ParameterTelegram& request, ReturnCode code) {
  ParameterTelegram response = parameter_response(request, static_cast<int32_t>(code.packed()));
  response.management |= management::kFailed;
  return response;
}

}  // namespace ipos::runtime
