// ipos bus: what runs over an SBus, planned, logged or replayed.
#include "tools/bus_verbs.hpp"
#include "tools/verbs.hpp"

namespace ipos::tools {

void add_bus(CLI::App& app, int& exit_code) {
  CLI::App* verb = app.add_subcommand("bus", "plan, watch, decode, measure and replay the traffic of an SBus");
  verb->require_subcommand(1);
  add_bus_plan(*verb, exit_code);
  add_bus_decode(*verb, exit_code);
  add_bus_monitor(*verb, exit_code);
  add_bus_load(*verb, exit_code);
  add_bus_replay(*verb, exit_code);
  add_bus_dbc(*verb, exit_code);
  verb->footer("Example:\n  ipos bus plan examples/scom/scom.toml");
}

}  // namespace ipos::tools
