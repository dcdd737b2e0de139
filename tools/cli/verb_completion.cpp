// ipos completion, complete and man: what the command line takes, for shells and for man(1).
#include <fmt/format.h>

#include "tools/cli/completion.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/manual.hpp"
#include "tools/cli/verbs.hpp"

namespace ipos::tools {

void add_completion(cli::Verb& program) {
  auto shell = std::make_shared<std::string>();
  cli::Verb& verb = program.verb("completion", "print a completion script for a shell");
  verb.option("SHELL", *shell, "bash, zsh or fish").required().one_of({"bash", "zsh", "fish"});
  verb.footer("Example, in ~/.bashrc:\n  source <(ipos completion bash)");
  verb.runs([shell, &program] {
    fmt::print("{}", *shell == "bash"  ? cli::bash_completion(program)
                     : *shell == "zsh" ? cli::zsh_completion(program)
                                       : cli::fish_completion(program));
    return kGood;
  });
}

void add_complete(cli::Verb& program) {
  auto words = std::make_shared<std::vector<std::string>>();
  cli::Verb& verb = program.verb("complete", "what may stand for the last word; the completions of shells ask it");
  verb.hide();
  verb.option("WORD", *words, "of the command line, without the program");
  verb.runs([words, &program] {
    for (const auto& [word, text] : cli::candidates(program, *words))
      fmt::print("{}{}{}\n", word, text.empty() ? "" : "\t", text);
    return kGood;
  });
}

void add_man(cli::Verb& program) {
  cli::Verb& verb = program.verb("man", "print the manual page in the form of man(1)");
  verb.footer("Example:\n  ipos man | man -l -");
  verb.runs([&program] {
    fmt::print("{}", cli::manual_page(program, "ipos " IPOS_VERSION));
    return kGood;
  });
}

}  // namespace ipos::tools
