// One pass over the code finds the starts of commands and checks operands; a second one checks that labels
// hit starts. Structures of the communication commands are checked for their whole length.
#include "vm/verify/verify.hpp"

#include <algorithm>
#include <bitset>

#include "vm/isa/blocks.hpp"

namespace ipos::vm {
namespace {

constexpr RuleInfo kRules[] = {
#define RULE(code, name, meaning) {Rule::name, code < 10 ? "V0" #code : "V" #code, meaning},
#include "vm/verify/rules.def"
};

bool ends_flow(Flow flow) { return flow == Flow::Jump || flow == Flow::Return || flow == Flow::End; }

class Checker {
 public:
  Checker(std::span<const uint32_t> code, const Limits& limits, std::span<Violation> out)
      : code_(code), limits_(limits), out_(out) {}

  uint32_t run() {
    const size_t longest =
        limits_.program_words < kMaxProgramWords ? limits_.program_words : kMaxProgramWords;
    if (code_.empty()) report(Rule::EmptyCode, 0);
    if (code_.size() > longest) report(Rule::TooLong, static_cast<uint32_t>(longest));
    if (count_ != 0) return count_;
    for (uint32_t at = 0; at < code_.size();) at += command(at);
    for (uint32_t at = 0; at < code_.size();) at += labels(at);
    return count_;
  }

 private:
  // Checks the command at `at`; returns its length, 1 for what is none.
  uint32_t command(uint32_t at) {
    const Decoded decoded = decode(code_, at);
    if (decoded.status == DecodeStatus::UnknownOpcode) return report(Rule::UnknownOpcode, at), 1;
    if (decoded.status == DecodeStatus::Truncated) {
      report(Rule::TruncatedCommand, at);
      return static_cast<uint32_t>(code_.size()) - at;  // what follows is part of it
    }
    if (decoded.status == DecodeStatus::ReservedBits) report(Rule::ReservedBits, at);
    starts_[at] = true;

    const Instruction& instruction = decoded.instruction;
    const Coding& row = coding(instruction.opcode);
    for (size_t n = 0; const OperandKind kind : row.kinds) {
      const int32_t value = instruction.operands[n];
      switch (kind) {
        case OperandKind::Variable: {
          const auto number = static_cast<uint32_t>(value);
          const uint32_t size = block_size(instruction, n);
          if (number >= limits_.variables)
            report(Rule::VariableRange, at);
          else if (size > limits_.variables - number)
            report(Rule::StructureRange, at);
          break;
        }
        case OperandKind::Bit:
          if (value > 31) report(Rule::BitRange, at);
          break;
        case OperandKind::Count:
          if (value < 1) report(Rule::StructureRange, at);
          break;
        case OperandKind::Keyword:
          if (!row.has_keyword(value)) report(Rule::UnknownKeyword, at);
          break;
        case OperandKind::Constant:
        case OperandKind::Label:
        case OperandKind::None: break;
      }
      ++n;
    }
    if ((instruction.opcode == Opcode::Task2 && limits_.tasks < 2) ||
        (instruction.opcode == Opcode::Task && limits_.tasks < 3) ||
        (instruction.opcode == Opcode::VarInt && limits_.tasks < 3))
      report(Rule::TaskMissing, at);
    if (at + decoded.words == code_.size() && !ends_flow(row.flow)) report(Rule::RunsOffEnd, at);
    return decoded.words;
  }

  uint32_t labels(uint32_t at) {
    if (!starts_[at]) return 1;
    const Coding& row = coding(static_cast<Opcode>(code_[at] & 0xFF));
    if (std::find(row.kinds.begin(), row.kinds.end(), OperandKind::Label) == row.kinds.end()) return row.words;
    const Decoded decoded = decode(code_, at);
    for (auto value = decoded.instruction.operands.begin(); const OperandKind kind : row.kinds) {
      const auto target = static_cast<uint32_t>(*value++);
      if (kind == OperandKind::Label && (target >= code_.size() || !starts_[target]))
        report(Rule::LabelTarget, at);
    }
    return decoded.words;
  }

  void report(Rule rule, uint32_t address) {
    if (count_ < out_.size()) out_[count_] = {rule, address};
    ++count_;
  }

  std::span<const uint32_t> code_;
  const Limits& limits_;
  std::span<Violation> out_;
  std::bitset<kMaxProgramWords> starts_;  // of commands
  uint32_t count_ = 0;
};

}  // namespace

std::span<const RuleInfo> rule_table() { return kRules; }

const RuleInfo& info(Rule rule) {
  for (const RuleInfo& row : kRules)
    if (row.rule == rule) return row;
  return kRules[0];
}

Verification verify(std::span<const uint32_t> code, const Limits& limits, std::span<Violation> out) {
  Verification result;
  result.violations = Checker(code, limits, out).run();
  if (result.violations == 0) result.image = VerifiedImage(code, limits);
  return result;
}

}  // namespace ipos::vm
