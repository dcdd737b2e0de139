// The verbs of `ipos` on Windows. What uses forks, sockets or terminals of POSIX is not there.
#include "tools/cli/verbs.hpp"
#include "tools/program_verbs.hpp"

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    {"build", add_build},  {"asm", add_asm},     {"disasm", add_disasm},   {"verify", add_verify},
    {"run", add_run},      {"test", add_test},   {"bus", nullptr},         {"canopen", nullptr},
    {"profibus", nullptr}, {"param", add_param}, {"watch", add_watch},     {"scan", add_scan},
    {"scope", add_scope},  {"diag", add_diag},   {"explain", add_explain}, {"fmt", add_fmt},
    {"lsp", nullptr},      {"debug", nullptr},   {"dap", nullptr},         {"completion", add_completion},
    {"man", add_man},      {"new", add_new},     {"serve", nullptr},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
