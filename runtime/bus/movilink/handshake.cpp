// A repeated request whose answer was lost gets the stored answer again, and does not run a second time.
#include "runtime/bus/movilink/handshake.hpp"

namespace ipos::runtime {

bool CyclicChannel::take(Time now, const ParameterTelegram& request) {
  settle(now);
  if (ready_ || request.synchronous() == acknowledged_) return false;
  request_ = request;
  response_ = execute_(now, request);
  ready_ = now + processing_;
  return true;
}

ParameterTelegram CyclicChannel::answer(Time now, const ParameterTelegram& request) {
  settle(now);
  if (!ready_ && request == request_) return response_;
  ParameterTelegram returned = request;
  returned.management &= static_cast<uint8_t>(~(management::kHandshake | management::kFailed));
  if (acknowledged_) returned.management |= management::kHandshake;
  return returned;
}

void CyclicChannel::settle(Time now) {
  if (!ready_ || now < *ready_) return;
  ready_.reset();
  acknowledged_ = request_.synchronous();
}

}  // namespace ipos::runtime
