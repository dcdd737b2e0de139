// The verbs of `ipos-demo`: from a source to a run.
#include "tools/cli/verbs.hpp"
#include "tools/program_verbs.hpp"

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    {"Run and test", "run", add_run},
    {"Write programs", "build", add_build},
    {"Images", "asm", add_asm},
    {"Images", "disasm", add_disasm},
    {"Images", "verify", add_verify},
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

}  // namespace ipos::tools
