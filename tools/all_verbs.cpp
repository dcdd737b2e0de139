// The verbs of `ipos`.
#include "tools/cli/verbs.hpp"
#include "tools/program_verbs.hpp"

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    {"Begin", "new", add_new},
    {"Begin", "serve", add_serve},
    {"Run and test", "run", add_run},
    {"Run and test", "test", add_test},
    {"Run and test", "debug", add_debug},
    {"Write programs", "build", add_build},
    {"Write programs", "fmt", add_fmt},
    {"Write programs", "explain", add_explain},
    {"Buses and drives", "bus", add_bus},
    {"Buses and drives", "watch", add_watch},
    {"Buses and drives", "param", add_param},
    {"Buses and drives", "scan", add_scan},
    {"Buses and drives", "scope", add_scope},
    {"Buses and drives", "diag", add_diag},
    {"Buses and drives", "canopen", add_canopen},
    {"Buses and drives", "profibus", add_profibus},
    {"Images", "asm", add_asm},
    {"Images", "disasm", add_disasm},
    {"Images", "verify", add_verify},
    {"Editors and shells", "lsp", add_lsp},
    {"Editors and shells", "dap", add_dap},
    {"Editors and shells", "completion", add_completion},
    {"Editors and shells", "man", add_man},
    {"Editors and shells", "complete", add_complete},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
