// Scaling of process data words, and the table of buses.
#include "runtime/drive/process_data.hpp"

#include <algorithm>
#include <iterator>

namespace ipos::runtime {
namespace {

using stdlib::ControlSource;
using stdlib::SetpointSource;

constexpr int32_t kSpeedDigit = 200;    // 0.2 rpm
constexpr int32_t kCurrentDigit = 100;  // 0.1 %
constexpr int64_t kFullScale = 0x4000;  // 100 %
constexpr int64_t kWhole = 100'000;   // 100 % in 1/1000 %

// P100 and P101 name the buses by different codes (1053 1610 p. 72). P837 to P101 of SBus 2 are MOVIDRIVE B's
// and stand with that bus.
constexpr BusSource kBuses[] = {
    {PoSource::Rs485, SetpointSource::Rs485, ControlSource::Rs485, SetpointSource::MasterRs485},
    {PoSource::Fieldbus, SetpointSource::Fieldbus, ControlSource::Fieldbus, std::nullopt},
    {PoSource::Sbus, SetpointSource::Sbus, ControlSource::Sbus, SetpointSource::MasterSbus}};

int64_t divide_rounded(int64_t value, int64_t by) {
  return value >= 0 ? (value + by / 2) / by : -((-value + by / 2) / by);
}

uint16_t saturated(int64_t value) {
  return static_cast<uint16_t>(static_cast<int16_t>(std::clamp<int64_t>(value, INT16_MIN, INT16_MAX)));
}

int32_t signed_word(uint16_t word) { return static_cast<int16_t>(word); }

template <typename T>
void set_first(std::optional<T>& field, T value) {
  if (!field) field = value;
}

}  // namespace

int32_t speed_of_word(uint16_t word) { return signed_word(word) * kSpeedDigit; }

int32_t speed_of_relative(uint16_t word, int32_t maximum) {
  return static_cast<int32_t>(divide_rounded(int64_t{signed_word(word)} * maximum, kFullScale));
}

uint16_t word_of_speed(int32_t speed) { return saturated(divide_rounded(speed, kSpeedDigit)); }

uint16_t relative_of_speed(int32_t speed, int32_t maximum) {
  return maximum == 0 ? 0 : saturated(divide_rounded(int64_t{speed} * kFullScale, maximum));
}

uint16_t word_of_current(int32_t current) { return saturated(divide_rounded(current, kCurrentDigit)); }

BusOrder decode_order(const DriveWords& words, const std::array<uint8_t, kProcessWords>& assignments,
                      int32_t maximum_speed) {
  BusOrder order;
  std::optional<uint16_t> position_low, position_high;
  for (size_t n = 0; n < kProcessWords; ++n) {
    const uint16_t word = words[n];
    switch (static_cast<PoAssignment>(assignments[n])) {
      case PoAssignment::Speed: set_first(order.speed, speed_of_word(word)); break;
      case PoAssignment::RelativeSpeed: set_first(order.speed, speed_of_relative(word, maximum_speed)); break;
      case PoAssignment::MaximumSpeed: set_first(order.maximum_speed, speed_of_word(word)); break;
      case PoAssignment::MaximumCurrent:
        set_first(order.maximum_current, signed_word(word) * kCurrentDigit);
        break;
      case PoAssignment::Slip: set_first(order.slip, speed_of_word(word)); break;
      case PoAssignment::Ramp: set_first(order.ramp, int32_t{word}); break;
      case PoAssignment::PiSetpoint:
        set_first(order.pi_setpoint, static_cast<int32_t>(signed_word(word) * kWhole / kFullScale));
        break;
      case PoAssignment::ControlWord1:
      case PoAssignment::ControlWord2:
        if (order.control_word) break;
        order.control_word = word;
        order.is_control_word_1 = static_cast<PoAssignment>(assignments[n]) == PoAssignment::ControlWord1;
        break;
      case PoAssignment::PositionLow: set_first(position_low, word); break;
      case PoAssignment::PositionHigh: set_first(position_high, word); break;
      case PoAssignment::Current: set_first(order.current, signed_word(word) * kCurrentDigit); break;
      // The program reads its own words.
      case PoAssignment::IposData:
      case PoAssignment::None: break;
    }
  }
  if (position_low && position_high)
    order.position = static_cast<int32_t>(uint32_t{*position_high} << 16 | *position_low);
  return order;
}

const BusSource& bus_source(PoSource bus) {
  return *std::find_if(std::begin(kBuses), std::end(kBuses), [&](const BusSource& row) { return row.bus == bus; });
}

std::optional<PoSource> setpoint_bus(const Settings& settings) {
  const auto source = static_cast<SetpointSource>(settings.setpoint_source);
  for (const BusSource& row : kBuses)
    if (source == row.setpoint || source == row.master) return row.bus;
  return std::nullopt;
}

// The master of a group sends the control word, too, whatever P101 says (MDX60B/61B p. 29).
std::optional<PoSource> control_bus(const Settings& settings) {
  if (is_master_slave(settings)) return setpoint_bus(settings);
  for (const BusSource& row : kBuses)
    if (static_cast<ControlSource>(settings.control_source) == row.control) return row.bus;
  return std::nullopt;
}

bool is_master_slave(const Settings& settings) {
  return stdlib::follows_sbus_master(settings.setpoint_source) || stdlib::follows_rs485_master(settings.setpoint_source);
}

}  // namespace ipos::runtime
