// The verbs of `ipos` on Windows. What uses forks, sockets or terminals of POSIX is not there.
#include "tools/cli/verbs.hpp"
#include "tools/program_verbs.hpp"

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    {"Begin", "new", add_new},
    {"Begin", "serve", nullptr},
    {"Run and test", "run", add_run},
    {"Run and test", "test", add_test},
    {"Run and test", "debug", nullptr},
    {"Write programs", "build", add_build},
    {"Write programs", "fmt", add_fmt},
    {"Write programs", "explain", add_explain},
    {"Buses and drives", "bus", nullptr},
    {"Buses and drives", "watch", add_watch},
    {"Buses and drives", "param", add_param},
    {"Buses and drives", "scan", add_scan},
    {"Buses and drives", "scope", add_scope},
    {"Buses and drives", "diag", add_diag},
    {"Buses and drives", "canopen", nullptr},
    {"Buses and drives", "profibus", nullptr},
    {"Images", "asm", add_asm},
    {"Images", "disasm", add_disasm},
    {"Images", "verify", add_verify},
    {"Editors and shells", "lsp", nullptr},
    {"Editors and shells", "dap", nullptr},
    {"Editors and shells", "completion", add_completion},
    {"Editors and shells", "man", add_man},
    {"Editors and shells", "complete", add_complete},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
