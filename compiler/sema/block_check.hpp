// Variables and structures given to system functions, against the blocks of vm/isa/blocks.def: are they of
// the type the command works on, and are there enough of them.
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "compiler/sema/expressions.hpp"
#include "vm/isa/blocks.hpp"

namespace ipos::compiler {

// What a system function expects of an argument.
struct BlockRequest {
  std::span<const vm::BlockInfo> rows;  // any of them
  int32_t count;                        // of the call, for rows without a length
  size_t argument;                      // counted from 1
  std::string_view function;
};

// The variables the command works on.
struct BlockFound {
  NumberRange range;
  vm::BlockUse use;
};

// Nothing, and an error, when the block goes beyond the last variable; a warning when the type is another
// one.
std::optional<BlockFound> check_block(Context& context, const BlockRequest& request, const Object& object,
                                      Span span);

}  // namespace ipos::compiler
