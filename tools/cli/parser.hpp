// Reads a command line by the rows of its verbs, and runs the verb that it names.
#pragma once

#include "tools/cli/verb.hpp"

namespace ipos::tools::cli {

// Runs what the words after the program's name ask for; the exit code of the verb, of a mistake or of --help.
// Mistakes go to standard error with what was probably meant. `version` is what --version prints.
int run(const Verb& program, const std::string& version, int argc, char** argv);

}  // namespace ipos::tools::cli
