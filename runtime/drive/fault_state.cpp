// Bookkeeping of faults and warnings.
#include "runtime/drive/fault_state.hpp"

#include <algorithm>

namespace ipos::runtime {

bool FaultState::raise(uint8_t number, FaultResponse response) {
  if (response == FaultResponse::None || pending(number)) return false;
  if (is_error(response)) {
    if (error_ != 0) return false;
    error_ = number;
    error_response_ = response;
    return true;
  }
  for (Warning& slot : warnings_)
    if (slot.number == 0) {
      slot = {number, response};
      return error_ == 0 && &slot == warnings_.data();
    }
  return false;
}

void FaultState::clear_cause(uint8_t number) {
  const auto end = std::remove_if(warnings_.begin(), warnings_.end(), [&](const Warning& warning) {
    return warning.number == number && warning.response != FaultResponse::Display;
  });
  std::fill(end, warnings_.end(), Warning{});
}

void FaultState::reset() {
  error_ = 0;
  error_response_ = FaultResponse::None;
  const auto end = std::remove_if(warnings_.begin(), warnings_.end(), [](const Warning& warning) {
    return warning.response == FaultResponse::Display;
  });
  std::fill(end, warnings_.end(), Warning{});
}

bool FaultState::pending(uint8_t number) const {
  return number != 0 &&
         (error_ == number || std::any_of(warnings_.begin(), warnings_.end(),
                                          [&](const Warning& w) { return w.number == number; }));
}

FaultStop FaultState::stop() const {
  FaultStop stop = error_ != 0 ? stop_of(error_response_) : FaultStop::None;
  for (const Warning& warning : warnings_)
    if (warning.number != 0) stop = std::max(stop, stop_of(warning.response));
  return stop;
}

}  // namespace ipos::runtime
