// Warnings about what variables hold: a value where the number of a variable belongs, a constant of another
// family, a number written as a constant, and variables that nobody writes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/ast/ast.hpp"
#include "compiler/sema/context.hpp"

namespace ipos::compiler {

// A number that was taken (numof, DPointer) leads to a block of variables, not only to the one it names: the
// second variable of a telegram, the eight of MLDATA. Variables so close after it count as used.
inline constexpr uint32_t kReachOfNumber = 8;

// After all bodies were checked: looks at the accesses of the whole program.
void check_variable_use(const ast::Program& program, Context& context);

// keyword_family.cpp: warns of a constant whose name belongs to another command or member than the one it is
// given to. `wanted`: beginnings of the names that belong there. `place`: what it is given to, `there`: the
// constant that has its value there.
void check_family(Context& context, Span constant, const std::vector<std::string_view>& wanted, int32_t value,
                  const std::string& place, const std::string& there);

}  // namespace ipos::compiler
