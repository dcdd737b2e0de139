// A drive server without its station: the parameter channel needs neither program nor bus.
#include "tools/unit/station_access.hpp"

#include <fmt/format.h>

#include "runtime/signals/parameter_channel.hpp"
#include "runtime/unit/unit_interface.hpp"
#include "tools/cli/failure.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/parameters/running_station.hpp"

namespace ipos::tools {
namespace {

class StationAccess final : public ParameterAccess {
 public:
  StationAccess(runtime::StationConfig config, std::string plant)
      : config_(std::move(config)), plant_(std::move(plant)), drive_(*config_.unit, config_.machine, config_.options) {
    uint16_t inputs = 0;
    for (const runtime::InputSetting& input : config_.inputs)
      if (input.level) inputs = static_cast<uint16_t>(inputs | 1U << input.input);
    drive_.state().set_inputs(inputs);
    drive_.state().set_analog(config_.analog);
    if (!config_.profibus.bus.bus.empty()) drive_.show_fieldbus_card(config_.profibus.address);
  }

  void open_memory(runtime::FileUse use) {
    if (config_.nvram.empty()) return;
    auto medium = runtime::open_file_medium(config_.nvram, use);
    if (!medium) throw Failure(kIoError, fmt::format("{}: {}", config_.nvram, medium.error()));
    if (const auto refused = drive_.memory().open(std::move(*medium), config_.nvram))
      throw Failure(kBadInput,
                    fmt::format("{}:{}:{}: error: station '{}': {}", plant_, config_.nvram_place.line,
                                config_.nvram_place.column, config_.name, *refused));
    tell();
  }

  // Returns false when a parameter of the plant file is refused; all are printed.
  bool set_parameters() {
    bool good = true;
    for (const runtime::ParameterSetting& setting : config_.parameters)
      if (const auto refused = drive_.set_parameter(setting.parameter, setting.value)) {
        fmt::print(stderr, "{}:{}:{}: error: station '{}': {}\n", plant_, setting.place.line,
                   setting.place.column, config_.name, *refused);
        good = false;
      }
    return good;
  }

  AccessReply execute(stdlib::Service service, uint16_t index, int32_t value) override {
    const runtime::ParameterReply reply = signals::parameter_channel(drive_, service, index, value);
    tell();
    if (reply) return *reply;
    return tl::unexpected(AccessError{reply.error(), {}});
  }

  std::string name() const override {
    return plant_.empty() ? fmt::format("{} as delivered", config_.unit->name)
                          : fmt::format("{} of {}", config_.name, plant_);
  }
  const stdlib::UnitType& unit() const override { return *config_.unit; }

  std::string forgets() const override {
    if (!config_.nvram.empty()) return {};
    return fmt::format("{}:{}:{}: station '{}' has no memory file; give it one with nvram = \"{}.nv\"",
                       plant_, config_.place.line, config_.place.column, config_.name, config_.name);
  }

  std::string overridden_by(uint16_t index) const override {
    for (const runtime::ParameterSetting& setting : config_.parameters) {
      const stdlib::Parameter* row = stdlib::parameter_table(*config_.unit).find(setting.parameter);
      if (row != nullptr && row->index == index)
        return fmt::format("{}:{}:{}: the plant file sets {} at every start; change it there", plant_,
                           setting.place.line, setting.place.column, setting.parameter);
    }
    return {};
  }

 private:
  void tell() {
    for (const auto& message : drive_.memory().take_messages())
      if (message.weight != runtime::Weight::Why) fmt::print(stderr, "ipos: warning: {}\n", message.text);
  }

  runtime::StationConfig config_;
  std::string plant_;
  runtime::UnitInterface drive_;
};

const runtime::StationConfig& choose(const runtime::PlantFile& file, const std::string& plant,
                                     const std::string& station) {
  refuse_gateway(file, plant, station);
  std::string names;
  for (const runtime::StationConfig& config : file.stations) {
    if (config.name == station) return config;
    names += (names.empty() ? "" : ", ") + config.name;
  }
  if (station.empty() && file.stations.size() == 1) return file.stations.front();
  throw Failure(kUsage, station.empty()
                            ? fmt::format("{} has several stations: choose one of {}", plant, names)
                            : fmt::format("{} has no station '{}', only {}", plant, station, names));
}

}  // namespace

std::unique_ptr<ParameterAccess> open_station(const std::string& plant, const std::string& station,
                                              runtime::FileUse use) {
  const runtime::PlantFile file = read_plant(plant);
  auto access = std::make_unique<StationAccess>(choose(file, plant, station), plant);
  access->open_memory(use);
  if (!access->set_parameters()) throw Failure(kBadInput, "");
  return access;
}

std::unique_ptr<ParameterAccess> open_factory(const stdlib::UnitType& unit) {
  runtime::StationConfig config;
  config.unit = &unit;
  return std::make_unique<StationAccess>(std::move(config), "");
}

}  // namespace ipos::tools
