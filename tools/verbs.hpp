// The verbs of the command line, one file each. Every function adds its subcommand and what it does to the
// app; the exit code of the verb that ran is stored in `exit_code`.
#pragma once

#include <CLI/CLI.hpp>

#include "tools/program.hpp"

namespace ipos::tools {

void add_build(CLI::App& app, int& exit_code);
void add_asm(CLI::App& app, int& exit_code);
void add_disasm(CLI::App& app, int& exit_code);
void add_verify(CLI::App& app, int& exit_code);
void add_run(CLI::App& app, int& exit_code);
void add_test(CLI::App& app, int& exit_code);
void add_bus(CLI::App& app, int& exit_code);
void add_param(CLI::App& app, int& exit_code);
void add_watch(CLI::App& app, int& exit_code);
void add_scan(CLI::App& app, int& exit_code);
void add_explain(CLI::App& app, int& exit_code);
void add_fmt(CLI::App& app, int& exit_code);
void add_lsp(CLI::App& app, int& exit_code);
void add_debug(CLI::App& app, int& exit_code);
void add_dap(CLI::App& app, int& exit_code);

// -I, -D, -W, --unit and --diagnostics, for every verb that compiles.
void add_compile_options(CLI::App& verb, CompileFlags& flags);

}  // namespace ipos::tools
