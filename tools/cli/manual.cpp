// roff of the manual page: the program, then each verb with its words, options and example.
#include "tools/cli/manual.hpp"

#include <fmt/format.h>

#include "tools/cli/exit_codes.hpp"

namespace ipos::tools::cli {
namespace {

// A line that begins with a dot or an apostrophe is a request of roff; a plain '-' may be printed as a
// hyphen.
std::string escaped(const std::string& text) {
  std::string out;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    at_start = c == '\n';
  }
  return out;
}

std::string value_of(const Option::Row& row) {
  if (row.is_flag) return row.implied.empty() ? "" : "[=VALUE]";
  if (!row.choices.empty()) {
    std::string choices;
    for (const std::string& choice : row.choices) choices += (choices.empty() ? "" : "|") + choice;
    return " " + choices;
  }
  return row.kind.empty() ? " VALUE" : " " + row.kind;
}

std::string synopsis(const Verb& verb, const std::string& path) {
  std::string line = fmt::format(".B {}\n", escaped(path));
  if (!verb.verbs().empty()) return line + ".I VERB ...\n";
  for (const Option& option : verb.options())
    if (option.is_word())
      line += fmt::format(
          ".I {}\n", escaped(option.row().is_required ? option.row().names : "[" + option.row().names + "]"));
  return line + ".RI [ OPTION ...]\n";
}

void add_verb(std::string& out, const Verb& verb, const std::string& path) {
  out += fmt::format(".SS {}\n{}.PP\n{}.\n", escaped(path), synopsis(verb, path), escaped(verb.text()));
  for (const Option& option : verb.options()) {
    const Option::Row& row = option.row();
    const std::string value = option.is_word() ? "" : value_of(row);
    out += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", escaped(row.names), escaped(value), escaped(row.text));
  }
  if (!verb.footer().empty()) out += fmt::format(".PP\n.EX\n{}\n.EE\n", escaped(verb.footer()));
  for (const Verb& inner : verb.verbs()) add_verb(out, inner, path + " " + inner.name());
}

}  // namespace

std::string manual_page(const Verb& program, const std::string& version) {
  std::string out = fmt::format(".TH IPOS 1 \"\" \"{}\" \"\"\n.SH NAME\n{} \\- {}\n", version, program.name(),
                                escaped(program.text()));
  out += fmt::format(".SH SYNOPSIS\n.B {}\n.I VERB\n.RI [ OPTION ...]\n.SH VERBS\n", program.name());
  for (const Verb& verb : program.verbs())
    if (!verb.hidden()) add_verb(out, verb, program.name() + " " + verb.name());
  out += ".SH EXIT STATUS\n";
  for (const ExitCode& row : kExitCodes)
    out += fmt::format(".TP\n{}\n{}\n", row.code, escaped(std::string(row.meaning)));
  out +=
      ".SH ENVIRONMENT\n.TP\n.B NO_COLOR\nNo colours, also on a terminal.\n"
      ".SH NOTES\nNot affiliated with SEW-EURODRIVE. Do not trust a machine to a simulation.\n";
  return out;
}

}  // namespace ipos::tools::cli
