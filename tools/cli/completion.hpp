// Completion in shells: each has a few lines that ask the program (`ipos complete WORD...`), so that what is offered is
// read where it is checked: verbs, options, closed lists, units, signals of the plant that is named.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tools/cli/verb.hpp"

namespace ipos::tools::cli {

struct Candidate {
  std::string word;
  std::string text;  // what it does; may be empty
};

// What may stand for the last word. Nothing: a file, or anything. `--emit=as` may come in one word, or in three as bash
// divides it.
std::vector<Candidate> candidates(const Verb& program, std::vector<std::string> words);

std::string bash_completion(const Verb& program);
std::string zsh_completion(const Verb& program);
std::string fish_completion(const Verb& program);

}  // namespace ipos::tools::cli
