// The verbs of all programs. The last column is the room that has it: CMake tells of each room whether the program links it
// (ipos_program in tools/CMakeLists.txt).
#include "tools/program_verbs.hpp"

#include "tools/cli/verbs.hpp"
#if IPOS_HAS_debug
#include "tools/debug/onlookers.hpp"
#endif

#define IPOS_IF_1(add) add
#define IPOS_IF_0(add) nullptr
#define IPOS_CHOSEN(has, add) IPOS_IF_##has(add)
#define IPOS_IF(has, add) IPOS_CHOSEN(has, add)  // `has` is 0 or 1 by then
#define IPOS_VERB(group, name, room) \
  { group, #name, IPOS_IF(IPOS_HAS_##room, add_##name) }

namespace ipos::tools {
namespace {

constexpr VerbRow kVerbs[] = {
    IPOS_VERB("Begin", new, new),
    IPOS_VERB("Begin", serve, serve),
    IPOS_VERB("Run and test", run, run),
    IPOS_VERB("Run and test", test, test),
    IPOS_VERB("Run and test", campaign, campaign),
    IPOS_VERB("Run and test", debug, debug),
    IPOS_VERB("Run and test", trace, run),
    IPOS_VERB("Run and test", fmu, fmu),
    IPOS_VERB("Write programs", build, build),
    IPOS_VERB("Write programs", fmt, build),
    IPOS_VERB("Write programs", explain, explain),
    IPOS_VERB("Buses and drives", bus, bus),
    IPOS_VERB("Buses and drives", watch, unit),
    IPOS_VERB("Buses and drives", param, unit),
    IPOS_VERB("Buses and drives", scan, unit),
    IPOS_VERB("Buses and drives", scope, unit),
    IPOS_VERB("Buses and drives", diag, unit),
    IPOS_VERB("Buses and drives", fms, unit),
    IPOS_VERB("Buses and drives", canopen, bus),
    IPOS_VERB("Buses and drives", profibus, bus),
    IPOS_VERB("Images", asm, build),
    IPOS_VERB("Images", disasm, build),
    IPOS_VERB("Images", verify, build),
    IPOS_VERB("Editors and shells", lsp, editors),
    IPOS_VERB("Editors and shells", dap, debug),
    IPOS_VERB("Editors and shells", completion, cli),
    IPOS_VERB("Editors and shells", man, cli),
    IPOS_VERB("Editors and shells", complete, cli),
};

}  // namespace

std::span<const VerbRow> program_verbs() { return kVerbs; }

void join_rooms() {
#if IPOS_HAS_debug
  debug::offer_onlookers();  // of `ipos run --realtime`
#endif
}

}  // namespace ipos::tools
