// The rows of the command line as CLI11 takes them; nothing else knows CLI11.
#include "tools/cli/parser.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "tools/exit_codes.hpp"

namespace ipos::tools::cli {
namespace {

CLI::Option* add_flag(CLI::App& app, const Option::Row& row) {
  if (auto* const* text = std::get_if<std::string*>(&row.target))
    return app.add_flag(fmt::format("{}{{{}}}", row.names, row.implied), **text, row.text);
  bool& target = *std::get<bool*>(row.target);
  return app.add_flag_callback(
      row.names, [&target, sets = row.sets] { target = sets; }, row.text);
}

CLI::Option* add_value(CLI::App& app, const Option::Row& row) {
  return std::visit([&](auto* target) { return app.add_option(row.names, *target, row.text); }, row.target);
}

// Without an upper limit the range of CLI11 prints the largest number there is.
CLI::Validator at_least(uint64_t least) {
  const auto check = [least](const std::string& text) {
    uint64_t number = 0;
    const bool good = CLI::detail::lexical_cast(text, number) && text.front() != '-' && number >= least;
    return good ? std::string() : fmt::format("{} is not {} or more", text, least);
  };
  return {check, fmt::format("{} or more", least)};
}

CLI::Validator in_range(uint64_t least, uint64_t most) {
  const auto check = [least, most](const std::string& text) {
    uint64_t number = 0;
    const bool good =
        CLI::detail::lexical_cast(text, number) && text.front() != '-' && number >= least && number <= most;
    return good ? std::string() : fmt::format("{} is not in {} to {}", text, least, most);
  };
  return {check, fmt::format("{} to {}", least, most)};
}

void add_option(CLI::App& app, const Option& option) {
  const Option::Row& row = option.row();
  CLI::Option* const made = row.is_flag ? add_flag(app, row) : add_value(app, row);
  if (row.is_required) made->required();
  if (row.takes_one_each || row.separator != 0) made->allow_extra_args(false);
  if (row.separator != 0) made->delimiter(row.separator);
  if (!row.choices.empty()) made->check(CLI::IsMember(row.choices));
  if (row.range && row.range->second == UINT64_MAX)
    made->check(at_least(row.range->first));
  else if (row.range)
    made->check(in_range(row.range->first, row.range->second));
  if (row.check) made->check(CLI::Validator(row.check, row.kind));
}

void add_verb(CLI::App& app, const Verb& verb, int& exit_code) {
  for (const Option& option : verb.options()) add_option(app, option);
  for (const Verb& inner : verb.verbs())
    add_verb(*app.add_subcommand(inner.name(), inner.text()), inner, exit_code);
  if (!verb.verbs().empty()) app.require_subcommand(1);
  app.footer(verb.footer());
  if (verb.action()) app.callback([&verb, &exit_code] { exit_code = verb.action()(); });
}

}  // namespace

int run(const Verb& program, const std::string& version, int argc, char** argv) {
  int exit_code = kGood;
  CLI::App app{program.text(), program.name()};
  app.set_version_flag("--version", version);
  add_verb(app, program, exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(error);  // --help, --version
    fmt::print(stderr, "ipos: {}\n", error.what());
    const auto verbs = app.get_subcommands();
    fmt::print(stderr, "Try 'ipos {}--help'.\n", verbs.empty() ? "" : verbs.front()->get_name() + " ");
    return kUsage;
  }
  return exit_code;
}

}  // namespace ipos::tools::cli
