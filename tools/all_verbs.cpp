// The verbs of `ipos`.
#include "tools/cli/verbs.hpp"
#include "tools/program_verbs.hpp"

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    {"build", add_build},
    {"asm", add_asm},
    {"disasm", add_disasm},
    {"verify", add_verify},
    {"run", add_run},
    {"test", add_test},
    {"bus", add_bus},
    {"canopen", add_canopen},
    {"profibus", add_profibus},
    {"param", add_param},
    {"watch", add_watch},
    {"scan", add_scan},
    {"scope", add_scope},
    {"diag", add_diag},
    {"explain", add_explain},
    {"fmt", add_fmt},
    {"lsp", add_lsp},
    {"debug", add_debug},
    {"dap", add_dap},
    {"completion", add_completion},
    {"man", add_man},
    {"new", add_new},
    {"serve", add_serve},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
