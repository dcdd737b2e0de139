// Stations by name.
#include "tools/parameters/running_station.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/signals/parameter_channel.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {

void refuse_gateway(const runtime::PlantFile& file, const std::string& path, const std::string& name) {
  for (const runtime::ControlConfig& control : file.controls)
    if (control.as<runtime::GatewayConfig>() != nullptr && control.name == name)
      throw Failure(kUsage,
                    fmt::format("'{}' of {} is a gateway: it has no program, drive or parameters of its "
                                "own; `ipos diag` shows what it does",
                                name, path));
}

runtime::Station& find_station(runtime::Plant& plant, const std::string& path, const std::string& name) {
  refuse_gateway(plant.file(), path, name);
  std::string names;
  for (const auto& station : plant.stations()) {
    if (name.empty() ? plant.stations().size() == 1 : station->config().name == name) return *station;
    names += (names.empty() ? "" : ", ") + station->config().name;
  }
  throw Failure(kUsage, name.empty() ? fmt::format("which station of {}: {}?", path, names)
                                     : fmt::format("{} has no station '{}', only {}", path, name, names));
}

AccessReply RunningStation::execute(stdlib::Service service, uint16_t index, int32_t value) {
  const runtime::ParameterReply reply =
      service == stdlib::Service::Read ? std::as_const(station_).drive().parameters().read(index)
                                       : signals::parameter_channel(station_.drive(), service, index, value);
  if (reply) return *reply;
  return tl::unexpected(AccessError{reply.error(), {}});
}

std::string RunningStation::name() const {
  return plant_.empty() ? station_.config().name : fmt::format("{} of {}", station_.config().name, plant_);
}

}  // namespace ipos::tools
