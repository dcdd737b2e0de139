// Two passes: forward, each command by itself; backward, the best cut of every line into operations.
#include "vm/fast/predecode.hpp"

#include <algorithm>

#include "vm/context/arithmetic.hpp"
#include "vm/fast/commands.hpp"
#include "vm/fast/engine.hpp"
#include "vm/fast/fill_loop.hpp"
#include "vm/isa/operand_text.hpp"

namespace ipos::vm::fast {
namespace {

constexpr size_t kOperations = static_cast<size_t>(Operation::kCount);
constexpr size_t kLongest = 6;  // commands of an operation

// Words of each command. Programs have some dozen patterns to try for each of their commands, so nothing is looked up then.
constexpr auto kWords = [] {
  std::array<uint8_t, 256> words{};
#define OPCODE(code, name, text, flow, reads, writes, faults, meaning) words[code] = words_of(text);
#include "vm/isa/opcodes.def"
  return words;
}();

// A row of operations.def as a pattern.
struct Pattern {
  Operation operation;
  uint8_t count = 0;  // commands
  uint8_t words = 0;
  uint8_t met = 0;    // results that stay in a register
  bool loop = false;  // its last command leads back to its first
  std::array<Opcode, kLongest> opcodes{};
  std::array<uint8_t, kLongest> at{};  // where each begins, in words
  bool (*fits)(const Slot*) = nullptr;
};

template <class F>
constexpr Pattern make_pattern(Operation operation, std::initializer_list<Opcode> tail, int tail_words) {
  Pattern out;
  out.operation = operation;
  for (const Opcode opcode : F::kOpcodes) out.opcodes[out.count++] = opcode;
  for (const Opcode opcode : tail) out.opcodes[out.count++] = opcode;
  for (size_t part = 1; part < out.count; ++part)
    out.at[part] = static_cast<uint8_t>(out.at[part - 1] + kWords[static_cast<uint8_t>(out.opcodes[part - 1])]);
  out.words = static_cast<uint8_t>(F::kWords + tail_words);
  out.met = F::kMet;
  out.fits = F::fits;
  return out;
}

template <class L>
constexpr Pattern make_loop(Operation operation) {
  Pattern out = make_pattern<typename L::Body>(operation, {}, 0);
  out.fits = L::fits;
  out.loop = true;
  return out;
}

constexpr Pattern kPatterns[] = {
#define SPECIAL(name)
#define PLAIN(name) make_pattern<Fused<O<name>>>(Operation::name, {}, 0),
#define FUSED(name, ...) make_pattern<Fused<__VA_ARGS__>>(Operation::name, {}, 0),
#define FUSED_CALL(name, ...) make_pattern<Fused<__VA_ARGS__>>(Operation::name, {Opcode::Call}, 2),
#define FUSED_RET(name, ...) make_pattern<Fused<__VA_ARGS__>>(Operation::name, {Opcode::Ret}, 1),
#define FILL(name, ...) make_loop<FillLoop<__VA_ARGS__>>(Operation::name),
#include "vm/fast/operations.def"
};
constexpr size_t kPatternCount = std::size(kPatterns);
static_assert(std::all_of(std::begin(kPatterns), std::end(kPatterns), [](const Pattern& p) {
  return p.words == p.at[p.count - 1U] + kWords[static_cast<uint8_t>(p.opcodes[p.count - 1U])];
}));

// The patterns that begin with an opcode, as a list.
struct Lists {
  std::array<int16_t, 256> first;
  std::array<int16_t, kPatternCount> next;
};
constexpr Lists kLists = [] {
  Lists out{};
  out.first.fill(-1);
  for (size_t n = kPatternCount; n-- > 0;) {
    int16_t& first = out.first[static_cast<uint8_t>(kPatterns[n].opcodes[0])];
    out.next[n] = first;
    first = static_cast<int16_t>(n);
  }
  return out;
}();

constexpr const char* kNames[] = {
#define SPECIAL(name) #name,
#define PLAIN(name) #name,
#define FUSED(name, ...) #name,
#define FUSED_CALL(name, ...) #name,
#define FUSED_RET(name, ...) #name,
#define FILL(name, ...) #name,
#include "vm/fast/operations.def"
};

bool leads_elsewhere(Opcode opcode) {
  const Flow flow = coding(opcode).flow;
  return flow != Flow::Next && flow != Flow::Branch;
}

// A chain of comparisons of one variable, as seen from its first.
struct Chain {
  uint32_t count = 0;  // comparisons
  uint32_t dense = 0;  // of these with constants n, n + 1, ...
};
constexpr uint32_t kShortestSwitch = 3;

}  // namespace

const char* operation_name(Operation operation) { return kNames[static_cast<size_t>(operation)]; }

std::span<const Opcode> commands_of(Operation operation) {
  for (const Pattern& pattern : kPatterns)
    if (pattern.operation == operation) return {pattern.opcodes.data(), pattern.count};
  return {};
}

Predecoded::Predecoded(const VerifiedImage& program, std::span<Slot> memory)
    : program_(program), slots_(memory), base_(handler_base()) {
  fill();
  choose();
}

Operation Predecoded::operation(uint32_t address) const {
  for (size_t n = 0; n < kOperations; ++n)
    if (handler_of(static_cast<Operation>(n), base_) == slots_[address].command.handler)
      return static_cast<Operation>(n);
  return Operation::Leave;
}

uint32_t Predecoded::commands(uint32_t address) const {
  const Operation which = operation(address);
  switch (which) {
    case Operation::SwitchDense:
    case Operation::SwitchSparse: return slots_[address].command.b;
    case Operation::SetSwitchDense:
    case Operation::SetSwitchSparse: return slots_[address + 1].command.b + 1U;
    case Operation::Leave:
    case Operation::Call:
    case Operation::Ret: return 1;
    default: return static_cast<uint32_t>(commands_of(which).size());
  }
}

// Operands and numbers. line_at is 1 at the start of a command, for now.
void Predecoded::fill() {
  const std::span<const uint32_t> code = program_.code();
  for (Slot& slot : slots_) slot = {};
  uint16_t number = 0;
  for (uint32_t at = 0; at < code.size();) {
    const Decoded decoded = decode(code, at);
    const auto& operands = decoded.instruction.operands;
    const Coding& row = coding(decoded.instruction.opcode);
    const auto field = [&](size_t n) { return static_cast<uint16_t>(operands[n]); };
    const auto is = [&](size_t n, OperandKind kind) { return row.kinds[n] == kind; };
    Slot* s = &slots_[at];
    s->command = {handler_of(Operation::Leave, base_), field(0), field(1), number++};
    if (is(1, OperandKind::Constant)) s[1].constant.value = operands[1];
    if (decoded.instruction.opcode == Opcode::Copy || decoded.instruction.opcode == Opcode::BitMove ||
        decoded.instruction.opcode == Opcode::BitMoveNeg)
      s[1].command = {0, field(2), field(3), 0};
    line_at(at) = 1;
    at += decoded.words;
  }
}

void Predecoded::set_routes(uint32_t address, uint32_t words, uint32_t target) {
  const uint32_t last = address + words - 1;
  const int32_t from = slots_[address].command.number;
  const int32_t to = slots_[target].command.number;
  slots_[last].route = {static_cast<int16_t>(from + 1 - to),
                        static_cast<uint16_t>(slots_[target].command.number + line(target)),
                        static_cast<int16_t>(static_cast<int32_t>(target) - static_cast<int32_t>(last)),
                        static_cast<uint16_t>(last + 1)};
}

void Predecoded::choose() {
  const std::span<const uint32_t> code = program_.code();
  const auto opcode_at = [&](uint32_t at) { return static_cast<Opcode>(code[at] & 0xFF); };
  // The cost of the rest of the line from each of the last words, around a ring: 8 for an operation, less for
  // what stays in a register.
  std::array<uint32_t, 32> cost{};
  const auto cost_at = [&](uint32_t at) -> uint32_t& { return cost[at % cost.size()]; };
  Chain chain;  // of the command after
  for (uint32_t at = static_cast<uint32_t>(code.size()); at-- > 0;) {
    if (line_at(at) == 0) continue;
    const Opcode opcode = opcode_at(at);
    const uint32_t words = kWords[static_cast<uint8_t>(opcode)];
    if (!leads_elsewhere(opcode)) line_at(at) = static_cast<uint16_t>(line(at + words) + 1);
    Slot* s = &slots_[at];

    Operation best = Operation::Leave;
    uint32_t least = 8;
    if (opcode == Opcode::Call) best = Operation::Call;
    if (opcode == Opcode::Ret) best = Operation::Ret;
    for (int16_t n = kLists.first[static_cast<uint8_t>(opcode)]; n >= 0;
         n = kLists.next[static_cast<size_t>(n)]) {
      const Pattern& pattern = kPatterns[static_cast<size_t>(n)];
      bool fits = at + pattern.words <= code.size();
      for (size_t part = 1; fits && part < pattern.count; ++part)
        fits = opcode_at(at + pattern.at[part]) == pattern.opcodes[part];
      if (!fits || !pattern.fits(s)) continue;
      if (pattern.loop && code[at + pattern.words - 1U] != at) continue;
      const bool ends = leads_elsewhere(pattern.opcodes[pattern.count - 1U]);
      const uint32_t total = 8U - pattern.met - pattern.loop + (ends ? 0 : cost_at(at + pattern.words));
      if (best != Operation::Leave && total >= least) continue;
      best = pattern.operation;
      least = total;
    }

    if (opcode == Opcode::JmpEqHK) {
      const bool goes_on = chain.count != 0 && s[words].command.a == s->command.a;
      const bool dense = goes_on && bits(s[words + 1].constant.value) == bits(s[1].constant.value) + 1;
      chain = {goes_on ? chain.count + 1 : 1, dense ? chain.dense + 1 : 1};
      if (chain.count >= kShortestSwitch) {
        const bool straight = chain.dense >= kShortestSwitch;
        best = straight ? Operation::SwitchDense : Operation::SwitchSparse;
        least = 8;
        s->command.b = static_cast<uint16_t>(straight ? chain.dense : chain.count);
      }
    } else {
      const bool of_same =
          opcode == Opcode::SetHH && chain.count >= kShortestSwitch && s[words].command.a == s->command.a;
      if (of_same) {
        best = chain.dense >= kShortestSwitch ? Operation::SetSwitchDense : Operation::SetSwitchSparse;
        least = 8;
      }
      chain = {};
    }
    cost_at(at) = least;
    s->command.handler = handler_of(best, base_);
  }
  // Routes need the lines of their targets.
  for (uint32_t at = 0; at < code.size(); ++at) {
    if (line(at) == 0) continue;
    const Instruction instruction = decode(code, at).instruction;
    const Coding& row = coding(instruction.opcode);
    const auto label = size_t{row.operand_count} - 1;
    if (row.flow == Flow::Jump || row.flow == Flow::Branch || row.flow == Flow::Call)
      set_routes(at, row.words, static_cast<uint32_t>(instruction.operands[label]));
  }
}

}  // namespace ipos::vm::fast
