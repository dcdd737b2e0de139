// Shared pieces of the assembler's text form.
#include "compiler/asm/text_forms.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::compiler {

int label_position(vm::Opcode opcode) {
  const vm::OpcodeInfo& row = vm::info(opcode);
  for (int n = 0; n < row.operand_count; ++n)
    if (row.operands[static_cast<size_t>(n)].kind == vm::OperandKind::Label) return n;
  return -1;
}

std::optional<uint32_t> label_operand(const vm::Instruction& command) {
  const int at = label_position(command.opcode);
  if (at < 0) return std::nullopt;
  return static_cast<uint32_t>(command.operands[static_cast<size_t>(at)]);
}

bool is_bare(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '.' ||
         c == '[' || c == ']' || c == '@';
}

std::string in_quotes(std::string_view name) {
  if (!name.empty() && std::all_of(name.begin(), name.end(), is_bare)) return std::string(name);
  std::string out = "\"";
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += std::string("\\") + c;
    else if (byte < 0x20 || byte >= 0x7F)
      out += fmt::format("\\x{:02X}", byte);
    else
      out += c;
  }
  return out + '"';
}

}  // namespace ipos::compiler
