// ipos bus decode: a candump log in words and units.
#include <fmt/format.h>

#include <set>

#include "compiler/diag/places.hpp"
#include "tools/bus_verbs.hpp"
#include "tools/exit_codes.hpp"

namespace ipos::tools {
namespace {

struct DecodeFlags {
  std::string log;
  std::string names;
  CompileFlags compile;
};

// "(0946684800.000102)" as in the log, so that a line can be found again.
std::string time_text(const runtime::LogEntry& entry) {
  const std::string line = runtime::candump_line(entry.time, entry.bus, {});
  return line.substr(0, line.find(' '));
}

// Column of the identifier in a line as candump writes it; what is known of a line that read well.
size_t identifier_column(const runtime::LogEntry& entry) {
  return time_text(entry).size() + entry.bus.size() + 3;
}

int decode(const DecodeFlags& flags) {
  const runtime::TelegramNames names = names_of(flags.names, flags.compile);
  std::set<std::pair<bool, uint32_t>> unknown;
  const size_t bad = read_log(flags.log, [&](const runtime::LogEntry& entry, size_t line) {
    const runtime::Description description = runtime::describe(names, entry.frame);
    fmt::print("{} {} {}\n", time_text(entry), compiler::printable(entry.bus), description.text);
    if (!description.known && unknown.emplace(entry.frame.extended, entry.frame.id).second)
      fmt::print(stderr, "{}:{}:{}: note: nothing is known about identifier {}{}\n", flags.log, line,
                 identifier_column(entry), entry.frame.id, entry.frame.extended ? " (29 bits)" : "");
  });
  return bad == 0 ? kGood : kBadInput;
}

}  // namespace

void add_bus_decode(cli::Verb& bus) {
  auto flags = std::make_shared<DecodeFlags>();
  cli::Verb& verb = bus.verb("decode", "MOVILINK and variable telegrams of a candump log in words and units");
  verb.option("LOG", flags->log, "candump log; - is standard input").required();
  add_names_option(verb, flags->names);
  add_compile_options(verb, flags->compile);
  verb.footer("Example:\n  ipos bus decode can.log --names examples/scom/scom.toml");
  verb.runs([flags] { return decode(*flags); });
}

}  // namespace ipos::tools
