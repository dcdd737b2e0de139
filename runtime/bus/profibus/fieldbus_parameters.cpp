// Index and coding between fieldbus and unit.
#include "runtime/bus/profibus/fieldbus_parameters.hpp"

namespace ipos::profibus {
namespace {

constexpr int kDigits = 8;
constexpr int32_t kLargest = 99'999'999;

}  // namespace

std::optional<int32_t> from_bcd(uint32_t digits) {
  int32_t value = 0;
  for (int digit = kDigits - 1; digit >= 0; --digit) {
    const uint32_t nibble = digits >> 4 * digit & 0xF;
    if (nibble > 9) return std::nullopt;
    value = 10 * value + static_cast<int32_t>(nibble);
  }
  return value;
}

std::optional<uint32_t> to_bcd(int32_t value) {
  if (value < 0 || value > kLargest) return std::nullopt;
  uint32_t digits = 0;
  for (int digit = 0; digit < kDigits; ++digit, value /= 10)
    digits |= static_cast<uint32_t>(value % 10) << 4 * digit;
  return digits;
}

tl::expected<uint32_t, ReturnCode> FieldbusParameters::read(Time now, uint16_t fieldbus_index) {
  return serve(now, runtime::Service::Read, fieldbus_index, 0);
}

tl::expected<uint32_t, ReturnCode> FieldbusParameters::write(Time now, uint16_t fieldbus_index,
                                                             uint32_t data) {
  return serve(now, runtime::Service::Write, fieldbus_index, data);
}

tl::expected<uint32_t, ReturnCode> FieldbusParameters::serve(Time now, runtime::Service service,
                                                             uint16_t fieldbus_index, uint32_t data) {
  namespace codes = runtime::return_codes;
  if (cut_) return tl::unexpected(codes::kCommunication);
  if (fieldbus_index < kFirstParameterIndex) return tl::unexpected(codes::kInvalidIndex);
  const auto index = static_cast<uint16_t>(fieldbus_index - kFirstParameterIndex);
  const stdlib::Parameter* parameter = table_.find(index);
  const bool bcd = parameter != nullptr && parameter->bcd;
  auto value = static_cast<int32_t>(data);
  if (bcd && service == runtime::Service::Write) {
    const auto decimal = from_bcd(data);
    if (!decimal) return tl::unexpected(codes::kIncorrectValue);
    value = *decimal;
  }
  const auto stored = server_.serve(now, {service, index, 0, value});
  if (!stored) return tl::unexpected(stored.error());
  if (!bcd) return static_cast<uint32_t>(*stored);
  const auto digits = to_bcd(*stored);
  if (!digits) return tl::unexpected(codes::kSystemError);  // the list gives BCD to what does not fit
  return *digits;
}

}  // namespace ipos::profibus
