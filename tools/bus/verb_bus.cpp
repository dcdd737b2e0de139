// ipos bus: what runs over an SBus, planned, logged or replayed.
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/verbs.hpp"

namespace ipos::tools {

void add_bus(cli::Verb& app) {
  cli::Verb& verb = app.verb("bus", "plan, watch, decode, measure and replay the traffic of an SBus");
  add_bus_plan(verb);
  add_bus_decode(verb);
  add_bus_monitor(verb);
  add_bus_load(verb);
  add_bus_replay(verb);
  add_bus_dbc(verb);
  add_bus_dissector(verb);
  verb.footer("Example:\n  ipos bus plan examples/scom/scom.toml");
}

}  // namespace ipos::tools
