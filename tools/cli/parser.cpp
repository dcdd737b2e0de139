// The rows of the command line as CLI11 takes them; nothing else knows CLI11.
#include "tools/cli/parser.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <span>

#include "stdlib/spelling.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/notices.hpp"

namespace ipos::tools::cli {
namespace {

// CLI11 shows its own notation: "TEXT:{text,json}", "--watch{*}".
class Help : public CLI::Formatter {
  std::string make_option_name(const CLI::Option* option, bool is_word) const override {
    const std::string names = CLI::Formatter::make_option_name(option, is_word);
    return names.substr(0, names.find('{'));
  }
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string value = CLI::Formatter::make_option_opts(option);
    const size_t check = value.find(':');
    return check == std::string::npos ? value : " " + value.substr(check + 1);
  }
};

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
  for (const Verb& inner : verb.verbs()) {
    CLI::App* made = app.add_subcommand(inner.name(), inner.text());
    if (inner.hidden() || !inner.group().empty()) made->group(inner.hidden() ? "" : inner.group());
    add_verb(*made, inner, exit_code);
  }
  if (!verb.verbs().empty()) app.require_subcommand(1);
  app.footer(verb.footer());
  if (verb.action()) app.callback([&verb, &exit_code] { exit_code = verb.action()(); });
}

// What a word that fits nowhere was probably meant to be: a verb, an option of the verb.
std::string meant(const std::string& word, const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  const std::vector<std::string_view> candidates(names.begin(), names.end());
  return std::string(stdlib::nearest(word.substr(0, word.find('=')), candidates));
}

// The verb that was asked for, the innermost one.
const CLI::App& innermost(const CLI::App& app) {
  const auto verbs = app.get_subcommands();
  return verbs.empty() ? app : innermost(*verbs.front());
}

// Says what is wrong with the words of the command line; `words` are those after the program's name.
void tell_mistake(const CLI::App& app, const CLI::ParseError& error, std::span<char* const> words) {
  const CLI::App& verb = innermost(app);
  const bool lacks_verb = !verb.get_subcommands({}).empty();
  const size_t behind = &verb == &app ? 0 : 1;  // verbs of verbs stand one deep
  std::string odd;
  if (lacks_verb)
    odd = words.size() > behind && words[behind][0] != '-' ? words[behind] : "";
  else if (const auto left = verb.remaining(); !left.empty())
    odd = left.front();
  const std::string whole = behind == 0 ? app.get_name() : app.get_name() + " " + verb.get_name();
  if (odd.empty()) {
    fmt::print(stderr, "ipos: {}\n",
               lacks_verb ? "which verb? '" + whole + " --help' lists them" : error.what());
    return;
  }
  const std::string name = meant(odd, verb);
  fmt::print(stderr, "ipos: '{}' is no {} of '{}'{}\n", odd,
             lacks_verb             ? "verb"
             : odd.starts_with("-") ? "option"
                                    : "word",
             whole, name.empty() ? "" : "; did you mean '" + name + "'?");
}

}  // namespace

int run(const Verb& program, const std::string& version, int argc, char** argv) {
  int exit_code = kGood;
  CLI::App app{program.text(), program.name()};
  app.formatter(std::make_shared<Help>());
  app.allow_windows_style_options(false);  // a word that begins with / is a path on Windows, too
  app.set_version_flag("--version,-V", version);
  app.add_flag_callback(
      "--licences,--licenses", [] { throw CLI::CallForVersion(std::string(notices_text()), 0); },
      "Print the licences of ipos and of all that it contains");
  add_verb(app, program, exit_code);
  if (argc == 1 || (argc == 2 && std::string_view(argv[1]) == "help")) {
    fmt::print(argc == 1 ? stderr : stdout, "{}", app.help());
    return argc == 1 ? kUsage : kGood;
  }
  // CLI11 takes words from the last to the first.
  std::vector<std::string> words(argv + 1, argv + argc);
  if (words.front() == "help") {
    words.erase(words.begin());
    const auto& known = program.verbs();
    if (std::none_of(known.begin(), known.end(), [&](const Verb& verb) { return verb.name() == words.front(); }))
      words.resize(1);  // so that it is told
    else
      words.emplace_back("--help");
  }
  std::reverse(words.begin(), words.end());
  try {
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(error);  // --help, --version
    const size_t first = std::string_view(argv[1]) == "help" ? 2 : 1;
    tell_mistake(app, error, std::span<char* const>(argv, static_cast<size_t>(argc)).subspan(first));
    const auto verbs = app.get_subcommands();
    fmt::print(stderr, "Try 'ipos {}--help'.\n", verbs.empty() ? "" : verbs.front()->get_name() + " ");
    return kUsage;
  }
  return exit_code;
}

}  // namespace ipos::tools::cli
