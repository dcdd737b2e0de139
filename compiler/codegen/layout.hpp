// Puts the functions of a program together: main first, temporaries with numbers of their own for each task
// and interrupt routine, labels with addresses.
//
// Temporaries: main, every function started as a task and every one installed as an interrupt routine is a
// root. Roots run at the same time, so each has its own block of temporaries. A function that needs
// temporaries, or calls one that does, is there once for every root that reaches it ("copy@root"). Within a
// root a called function may use the temporaries its caller does not hold at that moment.
#pragma once

#include <optional>
#include <vector>

#include "compiler/codegen/code.hpp"
#include "compiler/diag/diag.hpp"
#include "compiler/sema/checked.hpp"
#include "stdlib/unit_types.hpp"
#include "vm/image/image.hpp"

namespace ipos::compiler {

struct GeneratedProgram {
  vm::Image image;
  std::vector<checked::MapEntry> temporaries;  // rows for the allocation map
};

// A program that is too long is an error, but is given all the same, for listings.
// `functions`: code by index of function; those nobody reaches are empty.
std::optional<GeneratedProgram> lay_out(const checked::Program& program,
                                        const std::vector<FunctionCode>& functions,
                                        const stdlib::UnitType& unit, const SourceMap& sources,
                                        Diagnostics& diagnostics);

}  // namespace ipos::compiler
