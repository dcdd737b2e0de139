// Types and lengths of blocks of variables.
#include "compiler/sema/block_check.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::compiler {
namespace {

using vm::BlockInfo;

// A value of the unit is nothing but words: an array, or a structure of the program, holds it as well. The
// other commands take orders, whose members have to be where the unit looks for them.
bool holds_words(const BlockInfo& row) {
  return row.opcode == vm::Opcode::GetSys || row.opcode == vm::Opcode::SetSys;
}

bool is_of_type(const Type& type, const BlockInfo& row) {
  if (row.type.empty()) return true;
  if (row.variables == 1 && row.type == "long") return type.scalar();
  if (type.structure != nullptr && type.count == 0 && type.structure->name == row.type) return true;
  const bool own = type.structure == nullptr || type.structure->span.begin.valid();
  return holds_words(row) && own && type.size() >= row.variables;
}

std::string expected_type(const BlockRequest& request) {
  std::string out;
  for (const BlockInfo& row : request.rows) {
    const bool array = row.type == "long" && row.variables > 1;
    out += (out.empty() ? "" : " or ") +
           (array ? fmt::format("long[{}]", row.variables) : std::string(row.type));
  }
  return out;
}

}  // namespace

std::optional<BlockFound> check_block(Context& context, const BlockRequest& request, const Object& object,
                                      Span span) {
  if (request.rows.empty()) return BlockFound{*object.extent, vm::BlockUse::Both};
  // Names like H10 and aliases have no type to be wrong.
  const bool typed = object.variable != nullptr && object.variable->storage != Storage::Alias;
  const BlockInfo* row = &request.rows.front();
  for (const BlockInfo& other : request.rows)
    if (typed ? is_of_type(object.type, other) && !is_of_type(object.type, *row)
              : other.variables < row->variables)
      row = &other;
  if (typed && !is_of_type(object.type, *row))
    context.diagnostics.report(Diag::StructureType, span,
                               {fmt::format("{}", request.argument), std::string(request.function),
                                expected_type(request), object.text(), type_text(object.type)});
  const int32_t size = row->variables == 0 ? request.count : row->variables;
  const int32_t last = object.place.number + size - 1;
  if (last >= context.unit.variables) {
    context.diagnostics.report(Diag::InvalidVariable, span,
                               {fmt::format("{}", last), std::string(context.unit.name),
                                fmt::format("{}", context.unit.variables - 1)});
    return std::nullopt;
  }
  return BlockFound{{static_cast<uint32_t>(object.place.number), static_cast<uint32_t>(last)}, row->use};
}

}  // namespace ipos::compiler
