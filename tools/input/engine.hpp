// The engines by name, as --engine takes them: reference, fast, native.
#pragma once

#include <string>

#include "runtime/unit/execution.hpp"
#include "tools/cli/verb.hpp"

namespace ipos::tools {

// Adds --engine to a verb. Empty: machine code where this build has it, else the fast engine.
void add_engine_option(cli::Verb& verb, std::string& engine);

// Fails for machine code that this build does not have.
runtime::Execution execution_of(const std::string& engine = {});

}  // namespace ipos::tools
