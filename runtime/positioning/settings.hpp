// What the parameters say, as positioning reads it every millisecond.
#pragma once

#include <cstdint>

#include "runtime/positioning/fixed_point.hpp"
#include "runtime/positioning/profile.hpp"

namespace ipos::runtime {

// Settings of P941.
enum class PositionSource : uint8_t { Motor = 0, External = 1, Absolute = 2 };

struct PositioningSettings {
#define POSITIONING_SETTING(member, number, value) int32_t member = value;
#include "runtime/positioning/settings.def"

  PositionSource position_source() const { return static_cast<PositionSource>(source); }
  EncoderFactor encoder_factor() const { return {factor_numerator, factor_denominator}; }
  // Between increments of the source of the actual position and those of the motor.
  EncoderFactor source_factor() const {
    return position_source() == PositionSource::Motor ? EncoderFactor{} : encoder_factor();
  }
  // A travel with this share of the travel speeds, 1000 is all of it (P930).
  TravelRules travel_rules(int32_t override_permille) const;
  // A reference travel with P901 or P902.
  TravelRules reference_rules(bool fast) const;
  bool operator==(const PositioningSettings&) const = default;
};

}  // namespace ipos::runtime
