// Assembler: text in the form of the disassembler, or written by hand, to an image. Mnemonics are read
// without regard to case; `;` and REM begin a comment; constants may be 15, -1, 0x0F, 0b1111 or 0F hex
// (IPOSplus p. 305); variables H1, H001 or a system variable by its compiler or assembler name.
#pragma once

#include <optional>

#include "compiler/diag/diag.hpp"
#include "compiler/source/source.hpp"
#include "vm/image/image.hpp"

namespace ipos::compiler {

// Nothing when there were errors. The unit is md60a unless .unit says otherwise.
std::optional<vm::Image> assemble(const SourceFile& source, Diagnostics& diagnostics);

}  // namespace ipos::compiler
