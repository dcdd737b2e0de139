// Pending faults and warnings of a drive and the stop they demand (1053 1610 p. 81; MOVITRAC 07 chapter 6.5).
// A fault stays until it is reset, a warning until its cause is gone.
#pragma once

#include <array>
#include <cstdint>

#include "stdlib/faults.hpp"

namespace ipos::runtime {

using stdlib::FaultResponse;

enum class FaultStop : uint8_t { None, Rapid, Emergency, Immediate };

constexpr FaultStop stop_of(FaultResponse response) {
  switch (response) {
    case FaultResponse::None:
    case FaultResponse::Display: return FaultStop::None;
    case FaultResponse::ImmediateError:
    case FaultResponse::ImmediateWarning: return FaultStop::Immediate;
    case FaultResponse::EmergencyError:
    case FaultResponse::EmergencyWarning: return FaultStop::Emergency;
    case FaultResponse::RapidError:
    case FaultResponse::RapidWarning: return FaultStop::Rapid;
  }
  return FaultStop::Immediate;
}

constexpr bool is_error(FaultResponse response) {
  return response >= FaultResponse::ImmediateError && response <= FaultResponse::RapidError;
}

class FaultState {
 public:
  // True when it is new and shown from now on: an error after another error is not, the first one stays.
  bool raise(uint8_t number, FaultResponse response);
  void clear_cause(uint8_t number);  // ends a warning
  void reset();                      // ends an error and what is only displayed

  // Number in status word and display; 0 is none. An error hides warnings, of warnings the first is shown.
  uint8_t shown() const { return error_ != 0 ? error_ : warnings_[0].number; }
  bool error() const { return error_ != 0; }
  bool warning() const { return error_ == 0 && warnings_[0].number != 0; }
  uint8_t error_number() const { return error_; }
  bool pending(uint8_t number) const;
  FaultStop stop() const;  // the hardest one that anything pending demands

 private:
  struct Warning {
    uint8_t number = 0;
    FaultResponse response = FaultResponse::None;
  };
  uint8_t error_ = 0;
  FaultResponse error_response_ = FaultResponse::None;
  std::array<Warning, 8> warnings_{};  // in order of arrival; as many as there are causes that can warn
};

}  // namespace ipos::runtime
