// Classes 1 to 7 of the return codes come from the gateway, class 8 from the drive (MOVITRAC 07 chapter 7.2).
#include "runtime/bus/movilink/gateway_channel.hpp"

#include "runtime/bus/movilink/length_refusal.hpp"

namespace ipos::runtime {
namespace {

constexpr int32_t kParameterOnly = 6;  // format of MOVLNK
constexpr uint8_t kFourOctets = 4;

}  // namespace

void GatewayChannel::take(Time now, const ParameterTelegram& request) {
  if (busy_ || request.synchronous() == acknowledged_) return;
  request_ = request;
  const auto service = service_from_code(request.service_code());
  if (service == Service::None)
    return finish(parameter_response(request, static_cast<int32_t>(request.data)));
  if (!service || !serves_(request.subindex))
    return finish(parameter_refusal(request, return_codes::kWrongManagement));
  if (is_write(*service) && request.data_length() != kFourOctets) return finish(length_refusal(request));
  MovilinkJob job;
  job.address = request.subindex;
  job.format = kParameterOnly;
  job.service = request.service_code();
  job.index = request.index;
  job.write_value = static_cast<int32_t>(request.data);
  busy_ = true;
  if (const auto refused = master_.start(now, job)) finish(parameter_refusal(request, *refused));
}

ParameterTelegram GatewayChannel::answer(const ParameterTelegram& request) const {
  if (!busy_ && request == request_) return response_;
  ParameterTelegram returned = request;
  returned.management &= static_cast<uint8_t>(~(management::kHandshake | management::kFailed));
  if (acknowledged_) returned.management |= management::kHandshake;
  return returned;
}

void GatewayChannel::power_off() {
  acknowledged_ = busy_ = false;
  request_ = response_ = {};
}

void GatewayChannel::on_exchange_done(Time /*now*/, const MovilinkResult& result) {
  finish(result.result != 0
             ? parameter_refusal(request_, ReturnCode::unpack(result.result))
             : parameter_response(request_, result.read_value.value_or(static_cast<int32_t>(request_.data))));
}

void GatewayChannel::finish(const ParameterTelegram& response) {
  busy_ = false;
  acknowledged_ = request_.synchronous();
  response_ = response;
}

}  // namespace ipos::runtime
