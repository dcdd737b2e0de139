// The verbs of `ipos` in a browser. What uses ports, sockets or terminals is not there.
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
    {"Buses and drives", "watch", nullptr},
    {"Buses and drives", "param", nullptr},
    {"Buses and drives", "scan", nullptr},
    {"Buses and drives", "scope", nullptr},
    {"Buses and drives", "diag", nullptr},
    {"Buses and drives", "canopen", nullptr},
    {"Buses and drives", "profibus", nullptr},
    {"Images", "asm", add_asm},
    {"Images", "disasm", add_disasm},
    {"Images", "verify", add_verify},
    {"Editors and shells", "lsp", nullptr},
    {"Editors and shells", "dap", nullptr},
    {"Editors and shells", "completion", nullptr},
    {"Editors and shells", "man", nullptr},
    {"Editors and shells", "complete", nullptr},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
