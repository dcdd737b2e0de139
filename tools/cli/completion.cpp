// Completion scripts. Each shell gets a table of verbs, their options and the values that are a closed list;
// all other words are completed as files.
#include "tools/cli/completion.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace ipos::tools::cli {
namespace {

// "--jobs,-j" in parts.
std::vector<std::string> names_of(const Option& option) {
  std::vector<std::string> names{""};
  for (const char c : option.row().names)
    if (c == ',')
      names.emplace_back();
    else
      names.back() += c;
  return names;
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : " ") + word;
  return out;
}

// What may follow a verb: its verbs, or its options.
std::vector<std::string> words_of(const Verb& verb) {
  std::vector<std::string> words;
  for (const Verb& inner : verb.verbs()) words.push_back(inner.name());
  for (const Option& option : verb.options())
    if (!option.is_word())
      for (const std::string& name : names_of(option)) words.push_back(name);
  words.emplace_back("--help");
  return words;
}

// Calls `visit` with every verb and the words that lead to it, the program first with none.
template <typename Visit>
void each_verb(const Verb& verb, const std::string& path, const Visit& visit) {
  visit(verb, path);
  for (const Verb& inner : verb.verbs())
    each_verb(inner, path.empty() ? inner.name() : path + " " + inner.name(), visit);
}

// In single quotes, for all three shells.
std::string in_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

// All that lead to a verb, as alternatives of a shell's `case`.
std::string paths_of(const Verb& program) {
  std::string paths;
  each_verb(program, "", [&](const Verb&, const std::string& path) {
    if (!path.empty()) paths += (paths.empty() ? "" : "|") + in_quotes(path);
  });
  return paths;
}

}  // namespace

std::string bash_completion(const Verb& program) {
  std::string words;
  std::string values;
  each_verb(program, "", [&](const Verb& verb, const std::string& path) {
    words += fmt::format("    {}) words={}{} ;;\n", in_quotes(path), in_quotes(joined(words_of(verb))),
                         verb.verbs().empty() ? "" : " dash=");
    for (const Option& option : verb.options())
      for (const std::string& name : names_of(option))
        if (!option.row().choices.empty())
          values += fmt::format("    {}) words={} dash= ;;\n", in_quotes(path + " " + name),
                                in_quotes(joined(option.row().choices)));
  });
  return fmt::format(R"(# Completion of {0} for bash, printed by `{0} completion bash`.
_{0}() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}} path= words= dash=-
  local word
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    case "${{path:+$path }}$word" in
      {1}) path="${{path:+$path }}$word" ;;
    esac
  done
  case "$path" in
{2}  esac
  case "$path $prev" in
{3}  esac
  COMPREPLY=()
  if [[ -z $dash || $cur == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$words" -- "$cur")
  fi
}}
complete -o default -F _{0} {0}
)",
                     program.name(), paths_of(program), words, values);
}

std::string zsh_completion(const Verb& program) {
  std::string cases;
  each_verb(program, "", [&](const Verb& verb, const std::string& path) {
    std::string lines;
    for (const Verb& inner : verb.verbs())
      lines += fmt::format("      {}\n", in_quotes(fmt::format("{}:{}", inner.name(), inner.text())));
    std::string options;
    for (const Option& option : verb.options()) {
      if (option.is_word()) continue;
      std::string text = option.row().text;
      for (char& c : text)
        if (c == '[' || c == ']' || c == ':') c = ' ';
      const std::string value = option.row().is_flag ? ""
                                : option.row().choices.empty()
                                    ? ":value:_files"
                                    : fmt::format(":value:({})", joined(option.row().choices));
      for (const std::string& name : names_of(option))
        options += fmt::format(" \\\n        {}", in_quotes(fmt::format("*{}[{}]{}", name, text, value)));
    }
    cases += fmt::format("    {})\n", in_quotes(path));
    if (verb.verbs().empty())
      cases += fmt::format("      _arguments{} \\\n        '*:file:_files' ;;\n", options);
    else
      cases += fmt::format("      local -a verbs=(\n{}      )\n      _describe verb verbs ;;\n", lines);
  });
  return fmt::format(R"(#compdef {0}
# Completion of {0} for zsh, printed by `{0} completion zsh`.
_{0}() {{
  local path= word
  for word in "${{words[@]:1:CURRENT-2}}"; do
    case "${{path:+$path }}$word" in
      {1}) path="${{path:+$path }}$word" ;;
    esac
  done
  case "$path" in
{2}  esac
}}
compdef _{0} {0}
)",
                     program.name(), paths_of(program), cases);
}

std::string fish_completion(const Verb& program) {
  std::string out =
      fmt::format("# Completion of {0} for fish, printed by `{0} completion fish`.\n", program.name());
  each_verb(program, "", [&](const Verb& verb, const std::string& path) {
    // After these words, and after none of the verbs that could follow them.
    std::string behind = "true";
    std::vector<std::string> parts{""};
    for (const char c : path)
      if (c == ' ')
        parts.emplace_back();
      else
        parts.back() += c;
    for (const std::string& part : parts)
      if (!part.empty()) behind += fmt::format("; and __fish_seen_subcommand_from {}", part);
    std::vector<std::string> inner_names;
    for (const Verb& inner : verb.verbs()) inner_names.push_back(inner.name());
    if (!inner_names.empty())
      behind += fmt::format("; and not __fish_seen_subcommand_from {}", joined(inner_names));
    const std::string condition = in_quotes(behind);
    for (const Verb& inner : verb.verbs())
      out += fmt::format("complete -c {} -n {} -f -a {} -d {}\n", program.name(), condition, inner.name(),
                         in_quotes(inner.text()));
    for (const Option& option : verb.options()) {
      if (option.is_word()) continue;
      std::string line = fmt::format("complete -c {} -n {}", program.name(), condition);
      for (const std::string& name : names_of(option))
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (!option.row().is_flag) line += " -r";
      if (!option.row().choices.empty()) line += " -f -a " + in_quotes(joined(option.row().choices));
      out += line + " -d " + in_quotes(option.row().text) + "\n";
    }
  });
  return out;
}

}  // namespace ipos::tools::cli
