// The parameters of a MOVITRAC 31 as PROFIBUS reaches them, over the parameter channel and over FMS alike:
// fieldbus index = parameter index + 1000, most values as 4-byte BCD (MOVITRAC 31 PROFIBUS, 3.7.5, 4.2.1, 5.3).
#pragma once

#include <cstdint>
#include <optional>

#include <tl/expected.hpp>

#include "runtime/bus/movilink/unit_servers.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::profibus {

using runtime::ReturnCode;
using runtime::Time;

inline constexpr uint16_t kFirstParameterIndex = 1000;  // on the fieldbus

// Eight decimal digits. Nothing for a digit above 9, or a number that has no such form.
std::optional<int32_t> from_bcd(uint32_t digits);
std::optional<uint32_t> to_bcd(int32_t value);

class FieldbusParameters {
 public:
  FieldbusParameters(runtime::ParameterServer& server, const stdlib::ParameterTable& table)
      : server_(server), table_(table) {}

  // The four octets as they travel, most significant first. A write returns the value stored.
  tl::expected<uint32_t, ReturnCode> read(Time now, uint16_t fieldbus_index);
  tl::expected<uint32_t, ReturnCode> write(Time now, uint16_t fieldbus_index, uint32_t data);

  // The link from the card to the inverter; cut, every service ends with a hardware fault.
  void cut_link(bool cut) { cut_ = cut; }

  const stdlib::ParameterTable& table() const { return table_; }

 private:
  tl::expected<uint32_t, ReturnCode> serve(Time now, runtime::Service service, uint16_t fieldbus_index,
                                           uint32_t data);

  runtime::ParameterServer& server_;
  const stdlib::ParameterTable& table_;
  bool cut_ = false;
};

}  // namespace ipos::profibus
