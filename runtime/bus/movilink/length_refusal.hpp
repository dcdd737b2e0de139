// A write of another length than 4 bytes over a fieldbus: it has a code of its own, and the length comes back (MOVITRAC 31
// PROFIBUS, 5.2; that the cards of other units and the gateway do so is ours).
#pragma once

#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/return_code.hpp"

namespace ipos::runtime {

inline ParameterTelegram length_refusal(const ParameterTelegram& request) {
  ParameterTelegram answer = parameter_refusal(request, return_codes::kTypeConflict);
  answer.management = static_cast<uint8_t>(request.management | management::kFailed);
  return answer;
}

}  // namespace ipos::runtime
