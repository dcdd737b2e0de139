// A station of a plant that runs, by its name, and its parameter channel.
#pragma once

#include <string>

#include "runtime/plant/plant.hpp"
#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools {

// A Failure names the stations there are. An empty name is the only one.
runtime::Station& find_station(runtime::Plant& plant, const std::string& path, const std::string& name);

// A Failure that says what a gateway has not, where the name is that of one.
void refuse_gateway(const runtime::PlantFile& file, const std::string& path, const std::string& name);

class RunningStation final : public ParameterAccess {
 public:
  // Without the name of its plant it is called by its own alone.
  explicit RunningStation(runtime::Station& station, std::string plant = {})
      : station_(station), plant_(std::move(plant)) {}

  AccessReply execute(stdlib::Service service, uint16_t index, int32_t value) override;
  std::string name() const override;
  const stdlib::UnitType& unit() const override { return station_.drive().unit(); }

 private:
  runtime::Station& station_;
  std::string plant_;
};

}  // namespace ipos::tools
