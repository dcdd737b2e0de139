// The verbs of `ipos` in a browser. What uses ports, sockets or terminals is not there.
#include "tools/cli/verbs.hpp"
#include "tools/program_verbs.hpp"

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    {"build", add_build},  {"asm", add_asm},     {"disasm", add_disasm}, {"verify", add_verify},
    {"run", add_run},      {"test", add_test},   {"bus", nullptr},       {"canopen", nullptr},
    {"profibus", nullptr}, {"param", nullptr},   {"watch", nullptr},     {"scan", nullptr},
    {"scope", nullptr},    {"diag", nullptr},    {"explain", add_explain}, {"fmt", add_fmt},
    {"lsp", nullptr},      {"debug", nullptr},   {"dap", nullptr},       {"completion", nullptr},
    {"man", nullptr},      {"new", add_new},     {"serve", nullptr},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
