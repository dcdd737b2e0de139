// Programs the verifier has to accept, made of any bytes.
#include "tests/fuzz/valid_code.hpp"

#include <array>

#include "vm/isa/isa.hpp"

namespace ipos::tests {
namespace {

constexpr uint32_t kLongest = 64;  // variables of a structure or a copy

// An operand that the verifier accepts; labels are numbers of commands at first.
int32_t operand(Input& input, const vm::OperandInfo& row, uint32_t commands, const UnitShape& unit) {
  switch (row.kind) {
    case vm::OperandKind::Variable: {
      const uint32_t number = input.u16();
      return static_cast<int32_t>(number < 0x8000 ? number % 16 * 8 : number % (unit.variables - kLongest));
    }
    case vm::OperandKind::Bit: return input.u8() % 32;
    case vm::OperandKind::Count: return 1 + input.u8() % static_cast<int32_t>(kLongest);
    case vm::OperandKind::Constant: return input.u8() % 2 == 0 ? input.i32() : input.u8() - 20;
    case vm::OperandKind::Label: return static_cast<int32_t>(input.below(commands + 1));
    case vm::OperandKind::Keyword: {
      std::array<int32_t, 32> values{};
      size_t count = 0;
      for (const vm::KeywordInfo& keyword : vm::keyword_table())
        if (keyword.set == row.keyword_set) values[count++] = keyword.value;
      return values[input.u8() % count];
    }
    case vm::OperandKind::None: break;
  }
  return 0;
}

// Does a unit of this shape have the command?
bool has(const UnitShape& unit, vm::Opcode opcode) {
  if (opcode == vm::Opcode::Task2) return unit.tasks >= 2;
  return unit.tasks >= 3 || (opcode != vm::Opcode::Task && opcode != vm::Opcode::VarInt);
}

// Variable interrupts 0 and 1 on tasks 2 and 3, the three of task 1, both tasks, as far as the unit has them;
// routines and tasks anywhere. `count` commands follow.
void prepare(Input& input, uint32_t count, const UnitShape& unit, std::vector<vm::Instruction>& commands) {
  const uint32_t preparation = unit.tasks >= 3 ? 2 * 6 + 3 + 2 : unit.tasks == 2 ? 3 + 1 : 3;
  const auto label = [&] { return static_cast<int32_t>(input.below(count + preparation)); };
  for (int32_t n = 0; n < 2 && has(unit, vm::Opcode::VarInt); ++n) {
    const int32_t structure = 900 + 10 * n;
    const int32_t elements[] = {n + 1, n, static_cast<int32_t>(input.below(20)), input.u8() % 10,
                                1 + input.u8() % 10};
    const int32_t places[] = {0, 1, 2, 4, 5};
    for (size_t k = 0; k < 5; ++k)
      commands.push_back({vm::Opcode::SetHK, {structure + places[k], elements[k]}});
    commands.push_back({vm::Opcode::VarInt, {structure, label()}});
  }
  for (int32_t keyword = 1; keyword <= 3; ++keyword)
    commands.push_back({vm::Opcode::SetInt, {keyword, label()}});
  for (const vm::Opcode start : {vm::Opcode::Task2, vm::Opcode::Task})
    if (has(unit, start)) commands.push_back({start, {1, label()}});
}

}  // namespace

std::vector<uint32_t> valid_code(Input& input, UnitShape unit) {
  std::vector<vm::Instruction> commands;
  const uint8_t size = input.u8();
  const uint32_t rest = 1 + size % 64;
  // Every second program first installs all interrupts and starts all tasks, so that they come about.
  const bool prepared = size % 2 == 1;
  if (prepared) prepare(input, rest, unit, commands);
  const auto preparation = static_cast<uint32_t>(commands.size());
  const uint32_t count = rest + preparation;
  commands.reserve(count + 1);
  for (uint32_t n = 0; n < rest; ++n) {
    vm::Instruction command;
    const vm::OpcodeInfo& row = vm::opcode_table()[input.u8() % vm::opcode_table().size()];
    if (!has(unit, row.opcode)) {
      commands.push_back({vm::Opcode::Nop, {}});
      continue;
    }
    command.opcode = row.opcode;
    for (size_t k = 0; k < static_cast<size_t>(row.operand_count); ++k)
      command.operands[k] = operand(input, row.operands[k], count, unit);
    commands.push_back(command);
  }
  if (prepared)
    commands.push_back({vm::Opcode::Jmp, {static_cast<int32_t>(preparation)}});
  else
    commands.push_back({vm::Opcode::End, {}});

  std::vector<int32_t> addresses;
  addresses.reserve(commands.size());
  int32_t next = 0;
  for (const vm::Instruction& command : commands) {
    addresses.push_back(next);
    next += vm::info(command.opcode).words;
  }
  std::vector<uint32_t> code;
  code.reserve(static_cast<size_t>(next));
  for (vm::Instruction& command : commands) {
    const vm::OpcodeInfo& row = vm::info(command.opcode);
    for (size_t k = 0; k < static_cast<size_t>(row.operand_count); ++k)
      if (row.operands[k].kind == vm::OperandKind::Label)
        command.operands[k] = addresses[static_cast<size_t>(command.operands[k])];
    std::array<uint32_t, vm::kMaxWords> words{};
    const uint32_t length = vm::encode(command, words);
    code.insert(code.end(), words.begin(), words.begin() + length);
  }
  return code;
}

}  // namespace ipos::tests
