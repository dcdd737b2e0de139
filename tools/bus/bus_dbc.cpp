// ipos bus dbc: a DBC file of the variable telegrams, the process data and the CANopen messages of a plant or program.
#include <fmt/format.h>

#include "runtime/bus/dbc/dbc.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

void add_bus_dbc(cli::Verb& bus) {
  struct Flags {
    std::string file;
    std::string out = "-";
    CompileFlags compile;
  };
  auto flags = std::make_shared<Flags>();
  cli::Verb& verb = bus.verb("dbc", "write a DBC file of variable telegrams, process data and CANopen");
  verb.option("FILE", flags->file, "plant (.toml), source (.IPC) or image (.ipx)").required();
  verb.option("-o", flags->out, "file to write; - is standard output");
  add_compile_options(verb, flags->compile);
  verb.footer("Example:\n  ipos bus dbc examples/scom/scom.toml -o scom.dbc");
  verb.runs([flags] {
    replace_file(flags->out, runtime::dbc_text(bus_names_of(flags->file, flags->compile).can.all));
    return kGood;
  });
}

}  // namespace ipos::tools
