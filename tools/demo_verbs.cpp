// The verbs of `ipos-demo`: from a source to a run.
#include "tools/cli/verbs.hpp"
#include "tools/program_verbs.hpp"

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    {"build", add_build}, {"asm", add_asm}, {"disasm", add_disasm}, {"verify", add_verify}, {"run", add_run},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
