// Completion: the rows of the command line answer, and each shell asks in its way.
#include "tools/cli/completion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

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

const Option* find_option(const Verb& verb, const std::string& name) {
  for (const Option& option : verb.options()) {
    const auto names = names_of(option);
    if (!option.is_word() && std::find(names.begin(), names.end(), name) != names.end()) return &option;
  }
  return nullptr;
}

// `typed` is what stands there of the value; of a list with commas the part after the last one is completed.
std::vector<Candidate> values_of(const Option& option, const std::string& typed, const std::vector<std::string>& words,
                                 const std::string& before = "") {
  const Option::Row& row = option.row();
  std::vector<std::string> values = row.choices;
  if (row.offer) values = row.offer(words);
  std::string front = before;
  if (row.separator != 0)
    if (const size_t last = typed.rfind(row.separator); last != std::string::npos) front += typed.substr(0, last + 1);
  std::vector<Candidate> found;
  for (const std::string& value : values) found.push_back({front + value, ""});
  return found;
}

}  // namespace

std::vector<Candidate> candidates(const Verb& program, std::vector<std::string> words) {
  if (words.empty()) words.emplace_back();
  const std::string typed = words.back() == "=" ? "" : words.back();
  const Verb* verb = &program;
  const auto next = [&] {
    return std::find_if(verb->verbs().begin(), verb->verbs().end(),
                        [&](const Verb& inner) { return inner.name() == words.front(); });
  };
  while (words.size() > 1) {
    const auto inner = next();
    if (inner == verb->verbs().end()) break;
    verb = &*inner;
    words.erase(words.begin());
  }
  std::vector<Candidate> found;
  const size_t count = words.size();
  const size_t equal = typed.find('=');
  const Option* option = nullptr;
  if (count > 1 && words[count - 1] == "=")  // --emit =
    option = find_option(*verb, words[count - 2]);
  else if (count > 2 && words[count - 2] == "=")  // --emit = as
    option = find_option(*verb, words[count - 3]);
  else if (count > 1 && (option = find_option(*verb, words[count - 2])) != nullptr && option->row().is_flag)
    option = nullptr;
  if (option != nullptr) {
    found = values_of(*option, typed, words);
  } else if (typed.starts_with("--") && equal != std::string::npos) {
    option = find_option(*verb, typed.substr(0, equal));
    if (option != nullptr) found = values_of(*option, typed.substr(equal + 1), words, typed.substr(0, equal + 1));
  } else if (typed.starts_with("-") || !verb->verbs().empty()) {
    for (const Verb& inner : verb->verbs())
      if (!inner.hidden()) found.push_back({inner.name(), inner.text()});
    for (const Option& one : verb->options())
      if (!one.is_word())
        for (const std::string& name : names_of(one)) found.push_back({name, one.row().text});
    found.push_back({"--help", "tell options and an example"});
  } else {
    for (const Option& one : verb->options())
      if (one.is_word())
        for (Candidate& value : values_of(one, typed, words)) found.push_back(std::move(value));
  }
  std::erase_if(found, [&](const Candidate& one) { return !one.word.starts_with(typed); });
  return found;
}

std::string bash_completion(const Verb& program) {
  return fmt::format(R"(# Completion of {0} for bash, printed by `{0} completion bash`.
_{0}() {{
  mapfile -t COMPREPLY < <("${{COMP_WORDS[0]}}" complete -- "${{COMP_WORDS[@]:1:COMP_CWORD}}" 2>/dev/null | cut -f 1)
  [[ ${{#COMPREPLY[@]}} -ne 1 || ${{COMPREPLY[0]}} != *[=.] ]] || compopt -o nospace 2>/dev/null
}}
complete -o default -F _{0} {0}
)",
                     program.name());
}

std::string zsh_completion(const Verb& program) {
  return fmt::format(R"(#compdef {0}
# Completion of {0} for zsh, printed by `{0} completion zsh`.
_{0}() {{
  local -a found words_and_texts
  found=("${{(@f)$("${{words[1]}}" complete -- "${{(@)words[2,CURRENT]}}" 2>/dev/null)}}")
  if [[ -z "${{found[*]}}" ]]; then
    _files
    return
  fi
  words_and_texts=("${{(@)${{(@)found//:/\\:}}/$'\t'/:}}")
  _describe '{0}' words_and_texts
}}
compdef _{0} {0}
)",
                     program.name());
}

std::string fish_completion(const Verb& program) {
  return fmt::format(R"(# Completion of {0} for fish, printed by `{0} completion fish`.
function __{0}_words
  set -l words (commandline -opc) (commandline -ct)
  $words[1] complete -- $words[2..-1] 2>/dev/null
end
complete -c {0} -a '(__{0}_words)'
)",
                     program.name());
}

}  // namespace ipos::tools::cli
