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
  std::string out;
};

// Without -o under the name that masters look for.
int write_gsd(const GsdFlags& flags) {
  const profibus::OptionType* option = profibus::find_option_type(flags.option);
  if (option == nullptr) {
    std::vector<std::string_view> words;
    for (const profibus::OptionType& known : profibus::option_types()) words.push_back(known.word);
    throw Failure(kUsage, fmt::format("'{}' is no PROFIBUS interface; known are {}", flags.option,
                                      fmt::join(words, ", ")));
  }
  replace_file(flags.out.empty() ? std::string(option->gsd_file) : flags.out, profibus::gsd_text(*option));
  return kGood;
}

}  // namespace

void add_profibus(cli::Verb& app) {
  auto flags = std::make_shared<GsdFlags>();
  cli::Verb& verb = app.verb("profibus", "files for configuration tools of PROFIBUS masters");
  cli::Verb& gsd = verb.verb("gsd", "write the device data file (GSD) of a PROFIBUS interface");
  gsd.option("OPTION", flags->option, "ffp31 or size0, as `option` of a station").required();
  gsd.option("-o", flags->out,
             "file to write, - is standard output; the name that masters look for when left out");
  gsd.footer("Example:\n  ipos profibus gsd ffp31");
  gsd.runs([flags] { return write_gsd(*flags); });
  verb.footer("Example:\n  ipos profibus gsd ffp31");
}

}  // namespace ipos::tools
