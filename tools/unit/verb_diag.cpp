// ipos diag: the five diagnostic pages of a station of a plant, at a moment of its run.
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/bus_plan/names.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/parameters/running_station.hpp"
#include "tools/unit/diag_pages.hpp"

namespace ipos::tools {
namespace {

struct DiagFlags {
  std::string plant;
  std::string station;
  std::string at = "1s";
  std::vector<std::string> pages;
  CompileFlags compile;
};

int diagnose(const DiagFlags& flags) {
  const auto plant = make_plant(read_plant_input(flags.plant, flags.compile), runtime::FileUse::Look);
  if (runtime::Gateway* gateway = plant->find_gateway(flags.station)) {
    plant->run_until(runtime::parse_duration(flags.at));
    fmt::print("{}", DiagPages::gateway(*gateway, plant->now()));
    return kGood;
  }
  runtime::Station& station = find_station(*plant, flags.plant, flags.station);
  DiagPages pages(*plant, station, runtime::can_names(*plant));
  plant->run_until(runtime::parse_duration(flags.at));
  const char* gap = "";
  for (const char* name : DiagPages::kNames) {
    const bool wanted =
        flags.pages.empty() || std::find(flags.pages.begin(), flags.pages.end(), name) != flags.pages.end();
    if (wanted) fmt::print("{}{}", std::exchange(gap, "\n"), pages.page(name));
  }
  return kGood;
}

}  // namespace

void add_diag(cli::Verb& app) {
  auto flags = std::make_shared<DiagFlags>();
  cli::Verb& verb = app.verb(
      "diag",
      "diagnostic pages of a drive: parameters, process data, RS-485, CAN, fieldbus; of a gateway its own");
  verb.option("PLANT", flags->plant, "plant (.toml), which runs for it").required();
  verb.option("STATION", flags->station, "which one, where the plant has several");
  verb.option("--at", flags->at, "at this time of the run, default 1s").check(check_time, "TIME");
  verb.option("--page", flags->pages, "only these: parameters, pd, rs485, can, fieldbus")
      .one_of({"parameters", "pd", "rs485", "can", "fieldbus"})
      .separated_by(',')
      .one_each();
  add_plant_options(verb, flags->compile);
  verb.footer("Example:\n  ipos diag examples/sbus-line/line.toml inverter1 --page can");
  verb.runs([flags] { return diagnose(*flags); });
}

}  // namespace ipos::tools
