// ipos canopen: what configuration tools of CANopen masters need from here.
#include <fmt/format.h>

#include "runtime/bus/canopen/eds.hpp"
#include "stdlib/unit_names.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/failure.hpp"
#include "tools/input/offers.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/input/plant_source.hpp"

namespace ipos::tools {
namespace {

struct EdsFlags {
  std::string plant;
  std::string station;
  std::string unit;
  std::string out = "-";
};

std::string check_unit(const std::string& name) {
  const stdlib::UnitType* unit = stdlib::find_unit_or_plate(name);
  if (unit != nullptr && unit->has(stdlib::Trait::Canopen)) return "";
  return fmt::format("'{}' is no unit with CANopen; known are {}", name, stdlib::unit_names(stdlib::Trait::Canopen));
}

const stdlib::UnitType& unit_of(const EdsFlags& flags) {
  if (flags.plant.empty() == flags.unit.empty())
    throw Failure(kUsage, "which unit? Write PLANT STATION, or --unit mdxb");
  if (!flags.unit.empty()) return *stdlib::find_unit_or_plate(flags.unit);
  const runtime::PlantFile plant = read_plant(flags.plant);
  std::string names;
  for (const runtime::StationConfig& station : plant.stations) {
    if (flags.station.empty() ? plant.stations.size() == 1 : station.name == flags.station)
      return *station.unit;
    names += (names.empty() ? "" : ", ") + station.name;
  }
  throw Failure(kUsage, flags.station.empty() ? fmt::format("which station of {}: {}?", flags.plant, names)
                                              : fmt::format("{} has no station '{}', only {}", flags.plant,
                                                            flags.station, names));
}

int write_eds(const EdsFlags& flags) {
  const stdlib::UnitType& unit = unit_of(flags);
  if (!unit.has(stdlib::Trait::Canopen))
    throw Failure(kUsage, fmt::format("unit {} has no CANopen profile, only {}", unit.name,
                                      stdlib::unit_names(stdlib::Trait::Canopen)));
  replace_file(flags.out, runtime::canopen::eds_text(unit));
  return kGood;
}

}  // namespace

void add_canopen(cli::Verb& app) {
  auto flags = std::make_shared<EdsFlags>();
  cli::Verb& verb = app.verb("canopen", "files for configuration tools of CANopen masters");
  cli::Verb& eds = verb.verb("eds", "write the electronic data sheet of a unit (EDS, CiA 306)");
  eds.option("PLANT", flags->plant, "plant (.toml)");
  eds.option("STATION", flags->station, "which one of the plant, where it has several");
  eds.option("--unit", flags->unit, "in place of a plant: a unit type").check(check_unit, "UNIT").offers([](const Words&) { return offered_units(); });
  eds.option("-o", flags->out, "file to write; - is standard output");
  eds.footer("Example:\n  ipos canopen eds --unit mdxb -o mdxb.eds");
  eds.runs([flags] { return write_eds(*flags); });
  verb.footer("Example:\n  ipos canopen eds --unit mdxb -o mdxb.eds");
}

}  // namespace ipos::tools
