// The verbs of the command line, one file each. Every function adds its verb, with options and what it does.
#pragma once

#include "tools/cli/verb.hpp"

namespace ipos::tools {

void add_build(cli::Verb& program);
void add_asm(cli::Verb& program);
void add_disasm(cli::Verb& program);
void add_verify(cli::Verb& program);
void add_run(cli::Verb& program);
void add_test(cli::Verb& program);
void add_campaign(cli::Verb& program);
void add_bus(cli::Verb& program);
void add_canopen(cli::Verb& program);
void add_profibus(cli::Verb& program);
void add_param(cli::Verb& program);
void add_watch(cli::Verb& program);
void add_scope(cli::Verb& program);
void add_diag(cli::Verb& program);
void add_scan(cli::Verb& program);
void add_explain(cli::Verb& program);
void add_fmt(cli::Verb& program);
void add_fms(cli::Verb& program);
void add_fmu(cli::Verb& program);
void add_lsp(cli::Verb& program);
void add_debug(cli::Verb& program);
void add_dap(cli::Verb& program);
void add_completion(cli::Verb& program);
void add_complete(cli::Verb& program);
void add_man(cli::Verb& program);
void add_trace(cli::Verb& program);
void add_serve(cli::Verb& program);
void add_new(cli::Verb& program);

}  // namespace ipos::tools
