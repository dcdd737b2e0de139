// ipos profibus: what configuration tools of PROFIBUS masters need from here.
#include <fmt/format.h>

#include <vector>

#include "runtime/bus/profibus/gsd.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools {
namespace {

struct GsdFlags {
  std::string option;
  std::string unit;
  std::string out;
};

// Without -o under the name that masters look for.
int write_gsd(const GsdFlags& flags) {
  const profibus::OptionType* option = profibus::find_option_type(flags.option, flags.unit);
  if (option == nullptr) {
    std::vector<std::string> known;
    for (const profibus::OptionType& row : profibus::option_types())
      known.push_back(fmt::format("{} ({})", row.word, row.unit));
    throw Failure(kUsage, fmt::format("'{}'{} is no PROFIBUS interface; known are {}", flags.option,
                                      flags.unit.empty() ? "" : fmt::format(" of unit {}", flags.unit),
                                      fmt::join(known, ", ")));
  }
  replace_file(flags.out.empty() ? std::string(option->gsd_file) : flags.out, profibus::gsd_text(*option));
  return kGood;
}

}  // namespace

void add_profibus(cli::Verb& app) {
  auto flags = std::make_shared<GsdFlags>();
  cli::Verb& verb = app.verb("profibus", "files for configuration tools of PROFIBUS masters");
  cli::Verb& gsd = verb.verb("gsd", "write the device data file (GSD) of a PROFIBUS interface");
  gsd.option("OPTION", flags->option, "ffp31, size0, dfp, as `option` of a station, or gateway").required();
  gsd.option("--unit", flags->unit, "of which unit, where several have such a card");
  gsd.option("-o", flags->out,
             "file to write, - is standard output; the name that masters look for when left out");
  gsd.footer("Example:\n  ipos profibus gsd dfp --unit md60a");
  gsd.runs([flags] { return write_gsd(*flags); });
  verb.footer("Example:\n  ipos profibus gsd ffp31");
}

}  // namespace ipos::tools
