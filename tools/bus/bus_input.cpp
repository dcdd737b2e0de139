// The dictionaries of the subcommands of `ipos bus`.
#include "runtime/bus_plan/names.hpp"
#include "runtime/bus_plan/plan.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

namespace {

std::unique_ptr<runtime::Plant> trial_run(const std::string& path, const CompileFlags& compile) {
  auto plant = make_plant(read_plant_input(path, compile, "sbus"), runtime::FileUse::Look);
  plant->run_until(runtime::PlanOptions{}.trial);
  return plant;
}

}  // namespace

runtime::BusNames bus_names_of(const std::string& path, const CompileFlags& compile) {
  return path.empty() ? runtime::BusNames{} : runtime::bus_names(*trial_run(path, compile));
}

runtime::BusNames bus_names_of(const NamesFlags& flags) {
  runtime::BusNames names = bus_names_of(flags.plant, flags.compile);
  names.can.canopen = flags.canopen;
  return names;
}

void add_names_options(cli::Verb& verb, NamesFlags& flags) {
  verb.option("--names,--plant,--program", flags.plant,
              "plant or program whose stations, parameters and variables are named");
  verb.flag("--canopen", flags.canopen, "the frames are those of CANopen nodes, also where no plant says so");
  add_plant_options(verb, flags.compile);
}

}  // namespace ipos::tools
