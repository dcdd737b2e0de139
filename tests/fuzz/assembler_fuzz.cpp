// Any text to the assembler: an image or an error, and the image comes back from its own disassembly in each
// set of names.
#include "compiler/asm/assembler.hpp"

#include "compiler/asm/disassembler.hpp"
#include "compiler/diag/render.hpp"
#include "tests/fuzz/programs.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  compiler::SourceMap map;
  compiler::Diagnostics diagnostics;
  const auto image =
      compiler::assemble(map.add("fuzz.asm", "", std::string(text_of(data, size))), diagnostics);
  require(image.has_value() != diagnostics.has_errors(), "there is an image or there are errors");
  require(diagnostics.all().empty() == compiler::render_text(diagnostics.all(), map, true).empty(),
          "messages are shown");
  if (!image) return 0;
  check_round_trips(*image);
  for (const auto names : {compiler::VariableNames::Assembler, compiler::VariableNames::Compiler}) {
    compiler::Diagnostics again;
    const auto same =
        compiler::assemble(map.add("again.asm", "", compiler::disassemble(*image, names)), again);
    require(same.has_value() && *same == *image, "names of system variables lead back to the same image");
  }
  return 0;
}
