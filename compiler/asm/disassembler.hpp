// Text of an image: assembler source that gives the same image again, and a listing for people. Text forms
// come from vm/isa/opcodes.def; directives (.unit .file .symbol .function .line WORD) are ours, see
// docs/reference/assembler.md.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "vm/image/image.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::compiler {

// How a system variable is written: H492, TARGET POS or TargetPos (IPOSplus p. 29).
enum class VariableNames : uint8_t { Numbers, Assembler, Compiler };

// Assembler text of any image: assemble(disassemble(x)) == x, also for code that is no valid program.
std::string disassemble(const vm::Image& image, VariableNames names = VariableNames::Numbers);

// Text of a source line (from 1) of a file of the image, or nothing when it is not at hand.
using SourceLines = std::function<std::optional<std::string_view>(size_t file, uint32_t line)>;

// Listing: source lines, each followed by its commands with word address and code words.
std::string listing(const vm::Image& image, const SourceLines& source,
                    VariableNames names = VariableNames::Numbers);

// One command; `label` is the text of its label operand, if it has one.
std::string command_text(const vm::Instruction& command, std::string_view label,
                         VariableNames names = VariableNames::Numbers);

// One command or one word that is none.
struct CodeItem {
  uint32_t address = 0;
  uint32_t words = 1;
  std::optional<vm::Instruction> command;
};

// Code cut into commands from word 0 on, covering every word once.
std::vector<CodeItem> code_items(std::span<const uint32_t> code);

}  // namespace ipos::compiler
