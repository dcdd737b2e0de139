// Completion scripts for shells, made of the rows of the command line.
#pragma once

#include <string>

#include "tools/cli/verb.hpp"

namespace ipos::tools::cli {

// For ~/.bashrc: complete -F of the program's name.
std::string bash_completion(const Verb& program);
// For a folder of $fpath, as _ipos.
std::string zsh_completion(const Verb& program);
// For ~/.config/fish/completions, as ipos.fish.
std::string fish_completion(const Verb& program);

}  // namespace ipos::tools::cli
