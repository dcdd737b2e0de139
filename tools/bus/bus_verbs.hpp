// The subcommands of `ipos bus`, one file each.
#pragma once

#include <string>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/words/bus_words.hpp"
#include "tools/cli/verb.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

void add_bus_plan(cli::Verb& bus);
void add_bus_decode(cli::Verb& bus);
void add_bus_monitor(cli::Verb& bus);
void add_bus_load(cli::Verb& bus);
void add_bus_replay(cli::Verb& bus);
void add_bus_dbc(cli::Verb& bus);
void add_bus_dissector(cli::Verb& bus);

// The dictionary of a plant or program for its lines; it runs for a moment, so that its programs define their objects.
// Without one `canopen` says that nodes are there.
struct NamesFlags {
  std::string plant;
  bool canopen = false;
  CompileFlags compile;
};
runtime::BusNames bus_names_of(const NamesFlags& flags);
runtime::BusNames bus_names_of(const std::string& path, const CompileFlags& compile);

// --names FILE, also as --plant and --program; --canopen; and what its programs are compiled with.
void add_names_options(cli::Verb& verb, NamesFlags& flags);

}  // namespace ipos::tools
