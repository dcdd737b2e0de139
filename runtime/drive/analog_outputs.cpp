// A share of 10 V, then what the mode makes of it.
#include "runtime/drive/analog_outputs.hpp"

#include <algorithm>

#include "runtime/motion/axis.hpp"

namespace ipos::runtime {

AnalogLevel analog_level(const AnalogOutputSettings& settings, const AxisState& axis, int32_t ramp_input, int32_t ipos) {
  constexpr int64_t kRpm = 3'000'000, kHertz = 100'000, kPercent = 150'000, kIpos = 10'000, kFull = 10'000;
  const auto share = [](int64_t value, int64_t whole) { return value * kFull / whole; };
  int64_t level = 0;
  switch (static_cast<AnalogFunction>(settings.function)) {
    case AnalogFunction::None: return {};
    case AnalogFunction::RampInput: level = share(ramp_input, kRpm); break;
    case AnalogFunction::SpeedSetpoint: level = share(axis.setpoint, kRpm); break;
    case AnalogFunction::ActualSpeed: level = share(axis.speed, kRpm); break;
    case AnalogFunction::ActualFrequency: level = share(axis.frequency, kHertz); break;
    case AnalogFunction::OutputCurrent: level = share(axis.output_current, kPercent); break;
    case AnalogFunction::ActiveCurrent: level = share(axis.active_current, kPercent); break;
    case AnalogFunction::UnitUtilization: level = share(axis.utilization, kPercent); break;
    case AnalogFunction::IposOutput: level = share(ipos, kIpos); break;
  }
  level = std::clamp(level * settings.scaling / 1'000, -kFull, kFull);
  const auto current = [&](int64_t from) {
    return AnalogLevel{0, static_cast<int32_t>(from + std::max<int64_t>(level, 0) * (20'000 - from) / kFull)};
  };
  switch (settings.mode) {
    case 1: return {static_cast<int32_t>(level), 0};
    case 2: return current(0);
    case 3: return current(4'000);
    default: return {};
  }
}

}  // namespace ipos::runtime
