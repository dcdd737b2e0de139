// Parameters as rules of the ramp generator.
#include "runtime/positioning/settings.hpp"

namespace ipos::runtime {
namespace {

constexpr int32_t kRampReference = 3'000'000;  // 1/1000 rpm: P911 and P912 are times for 3000 rpm

RampShape shape_of(int32_t value) {
  return value == 1 ? RampShape::Sine : value == 2 ? RampShape::Squared : RampShape::Linear;
}

}  // namespace

TravelRules PositioningSettings::travel_rules(int32_t override_permille) const {
  const EncoderFactor factor = source_factor();
  // No travel is planned faster than the drive may turn (ours).
  const auto top = [&](int32_t speed) {
    const int64_t wanted = int64_t{std::max(speed, 0)} * override_permille / 1000;
    return rate_of_speed(std::min<int64_t>(wanted, std::max(maximum_speed, 0)), factor);
  };
  TravelRules rules;
  rules.cw = top(speed_cw);
  rules.ccw = top(speed_ccw);
  rules.reference = std::max<Rate>(1, rate_of_speed(kRampReference, factor));
  rules.up_ms = std::max(ramp_up, 1);
  rules.down_ms = std::max(ramp_down, 1);
  rules.shape = shape_of(ramp_shape);
  return rules;
}

TravelRules PositioningSettings::reference_rules(bool fast) const {
  PositioningSettings settings = *this;
  settings.speed_cw = settings.speed_ccw = fast ? reference_speed_1 : reference_speed_2;
  return settings.travel_rules(1000);
}

}  // namespace ipos::runtime
