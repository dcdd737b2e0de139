// A [[station]] of unit gateway: it is a master of its SBus, so it stands among the controls of the plant.
#include <algorithm>

#include "runtime/bus/profibus/card.hpp"
#include "runtime/plant_file/plant_reader.hpp"

namespace ipos::runtime {
namespace {

// SBus addresses, in the order in which their words stand in the process image.
std::vector<uint8_t> read_drives(PlantReader& reader, const toml::table& table) {
  std::vector<uint8_t> drives;
  const toml::node* node = table.get("drives");
  if (node == nullptr) return drives;
  const toml::array* list = node->as_array();
  if (list == nullptr) {
    reader.error(place_of(*node), "drives is a list of SBus addresses");
    return drives;
  }
  for (const toml::node& entry : *list) {
    int32_t address = 0;
    if (!reader.number(entry, "an SBus address", address)) continue;
    if (address < 0 || address >= kSbusAddressCount)
      reader.error(place_of(entry), "an SBus address is 0 to 63");
    else if (std::find(drives.begin(), drives.end(), address) != drives.end())
      reader.error(place_of(entry), fmt::format("the address {} stands twice", address));
    else
      drives.push_back(static_cast<uint8_t>(address));
  }
  if (drives.empty() || drives.size() > kMostGatewayDrives)
    reader.error(place_of(*node), fmt::format("a gateway has 1 to {} drives", kMostGatewayDrives));
  std::sort(drives.begin(), drives.end());
  return drives;
}

}  // namespace

void read_gateway(PlantReader& reader, const toml::table& table) {
  constexpr std::string_view kWhat = "a [[station]] of unit gateway";
  reader.known_keys(table, kWhat,
                    {"name", "unit", "profibus", "profibus_address", "sbus", "drives", "terminator",
                     "profibus_terminator"});
  ControlConfig config;
  config.place = place_of(table.source());
  config.name = reader.text(table, "name", kWhat, true);
  reader.new_station(config.name, config.place);
  reader.gateway_names.insert(config.name);
  config.sbus = reader.bus_name(table, "sbus", kWhat, true);
  config.terminator = reader.flag(table, "terminator");
  GatewayConfig& gateway = config.kind.emplace<GatewayConfig>();
  gateway.drives = read_drives(reader, table);
  ProfibusUse& use = gateway.profibus;
  use.option = &profibus::option_type(profibus::OptionKind::Gateway);
  use.option_place = config.place;
  use.terminator = reader.flag(table, "profibus_terminator");
  use.bus = reader.bus_use(table, "profibus", BusKind::Profibus);
  for (const std::string_view key : {"profibus", "profibus_address"})
    if (!table.contains(key)) reader.error(config.place, fmt::format("{} needs {} = ...", kWhat, key));
  use.address = static_cast<uint8_t>(
      reader.count(table, "profibus_address", profibus::kBroadcast, profibus::kNoAddressYet));
  reader.result.plant.controls.push_back(std::move(config));
}

}  // namespace ipos::runtime
