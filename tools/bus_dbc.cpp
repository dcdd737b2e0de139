// ipos bus dbc: a DBC file of the variable telegrams and process data of a plant or program.
#include <fmt/format.h>

#include "runtime/bus/movilink/dbc.hpp"
#include "tools/bus_verbs.hpp"
#include "tools/exit_codes.hpp"
#include "tools/files.hpp"

namespace ipos::tools {

void add_bus_dbc(CLI::App& bus, int& exit_code) {
  struct Flags {
    std::string file;
    std::string out = "-";
    CompileFlags compile;
  };
  auto flags = std::make_shared<Flags>();
  CLI::App* verb = bus.add_subcommand("dbc", "write a DBC file of variable telegrams and process data");
  verb->add_option("FILE", flags->file, "plant (.toml), source (.IPC) or image (.ipx)")->required();
  verb->add_option("-o", flags->out, "file to write; - is standard output");
  add_compile_options(*verb, flags->compile);
  verb->footer("Example:\n  ipos bus dbc examples/scom/scom.toml -o scom.dbc");
  verb->callback([flags, &exit_code] {
    const std::string text = runtime::dbc_text(names_of(flags->file, flags->compile));
    write_file(flags->out, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    exit_code = kGood;
  });
}

}  // namespace ipos::tools
