// The parameter channel between telegram and unit, the same on every interface except for one code.
#include "runtime/bus/movilink/unit_servers.hpp"

namespace ipos::runtime {

ParameterTelegram execute(Time now, ParameterServer& parameters, const ParameterTelegram& received,
                          ReturnCode wrong_length) {
  ParameterTelegram request = received;
  if (!parameters.has_subindices()) request.subindex = 0;
  const auto service = service_from_code(request.service_code());
  if (service == Service::None) return parameter_response(request, static_cast<int32_t>(request.data));
  if (!service) return parameter_refusal(request, return_codes::kWrongManagement);
  if (is_write(*service) && request.data_length() != 4) return parameter_refusal(request, wrong_length);
  const auto value =
      parameters.serve(now, {*service, request.index, received.subindex, static_cast<int32_t>(request.data)});
  return value ? parameter_response(request, *value) : parameter_refusal(request, value.error());
}

}  // namespace ipos::runtime
