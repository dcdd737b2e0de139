// Each case is executed turn by turn. What comes from outside, or has been there before, is a value without a number that stays the
// same; what is calculated from it is its text. A comparison that such a value leaves open makes cases of it: each begins the turn
// anew with what it assumes, and keeps that for all turns that follow.
#include "compiler/analysis/settling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "vm/isa/effects.hpp"

namespace ipos::compiler::analysis {
namespace {

using vm::Flow;
using vm::Instruction;
using vm::Opcode;

constexpr uint64_t kMostCommands = 500'000;  // that are executed for an answer
constexpr int64_t kMostBegins = 1024;          // values that kept variables are tried with
constexpr int64_t kMostOfOne = 64;
constexpr uint64_t kMostTurns = 1000;
constexpr size_t kLongText = 4000;

struct Value {
  bool is_number = false;
  int32_t number = 0;
  std::string text{};  // of what has no number
  bool operator==(const Value&) const = default;
};

Value number(int64_t value) { return {true, static_cast<int32_t>(static_cast<uint32_t>(value)), {}}; }
std::string text_of(const Value& value) { return value.is_number ? fmt::format("{}", value.number) : value.text; }

using Variables = std::map<uint32_t, Value>;

struct Case {
  Variables kept;
  std::map<std::string, Interval> assumed;
  uint64_t turns = 0;
};

class Settler {
 public:
  Settler(const Places& places, const Turn& turn, const std::set<uint32_t>& kept) : places_(places), turn_(turn), kept_(kept) {}

  std::optional<uint64_t> run() {
    if (!begin()) return std::nullopt;
    uint64_t most = 0;
    while (!open_.empty()) {
      Case one = std::move(open_.back());
      open_.pop_back();
      const auto after = execute(one);
      if (!after) return std::nullopt;
      if (!*after) continue;  // cases were made of it
      if (**after == one.kept) {
        most = std::max(most, one.turns);
        continue;
      }
      one.kept = std::move(**after);
      if (++one.turns > kMostTurns) return std::nullopt;
      open_.push_back(std::move(one));
    }
    return most;
  }

 private:
  bool begin() {
    open_.push_back({});
    for (const uint32_t variable : kept_) {
      const Interval range = places_.values.at(turn_.head(), variable);
      const bool few = !range.is_empty() && range.most - range.least < kMostOfOne;
      std::vector<Case> cases;
      for (const Case& one : open_)
        if (few) {
          for (int64_t value = range.least; value <= range.most; ++value) (cases.emplace_back(one)).kept[variable] = number(value);
        } else {
          (cases.emplace_back(one)).kept[variable] = {false, 0, fmt::format("once H{}", variable)};
        }
      if (static_cast<int64_t>(cases.size()) > kMostBegins) return false;
      open_ = std::move(cases);
    }
    return true;
  }

  static Value value_of(const Variables& variables, uint32_t variable) {
    const auto found = variables.find(variable);
    return found == variables.end() ? Value{false, 0, fmt::format("H{}", variable)} : found->second;
  }

  static Value calculated(const Instruction& code, const Value& a, const Value& b) {
    if (a.is_number && b.is_number) {
      const int64_t x = a.number, y = b.number;
      const auto bits = static_cast<uint32_t>(a.number);
      switch (code.opcode) {
        case Opcode::AddHH:
        case Opcode::AddHK: return number(x + y);
        case Opcode::SubHH:
        case Opcode::SubHK: return number(x - y);
        case Opcode::MulHH:
        case Opcode::MulHK: return number(x * y);
        case Opcode::AndHH:
        case Opcode::AndHK: return number(x & y);
        case Opcode::OrHH:
        case Opcode::OrHK: return number(x | y);
        case Opcode::XorHH:
        case Opcode::XorHK: return number(x ^ y);
        case Opcode::ShlHH:
        case Opcode::ShlHK: return number(bits << (y & 31));
        case Opcode::ShrHH:
        case Opcode::ShrHK: return number(bits >> (y & 31));
        case Opcode::AshrHH:
        case Opcode::AshrHK: return number(a.number >> (y & 31));
        default: break;  // a text is as good
      }
    }
    return texts(code, a, b);
  }

  static Value texts(const Instruction& code, const Value& a, const Value& b) {
    return {false, 0, fmt::format("({} {} {})", text_of(a), static_cast<int>(code.opcode), text_of(b))};
  }

  // The kept variables behind the turn; an empty inner one: cases were made; none: nobody knows.
  std::optional<std::optional<Variables>> execute(const Case& one) {
    Variables now = one.kept;
    std::vector<size_t> returns;
    size_t at = turn_.head();
    for (bool first = true; first || at != turn_.head(); first = false) {
      if (at == kNone || ++executed_ > kMostCommands) return std::nullopt;
      const Command& command = places_.graph.commands[at];
      const Instruction& code = command.code;
      switch (vm::coding(code.opcode).flow) {
        case Flow::Branch: {
          const Value left = value_of(now, static_cast<uint32_t>(code.operands[0]));
          const Value right = vm::has_constant(code) ? number(code.operands[1]) : value_of(now, static_cast<uint32_t>(code.operands[1]));
          const std::optional<bool> jumps = compare(one, code.opcode, left, right);
          if (!jumps) return std::optional<Variables>{};
          at = *jumps ? command.label : command.next;
          break;
        }
        case Flow::SystemCall: {
          const std::optional<bool> calls = compare(one, Opcode::JmpNeHK, {false, 0, fmt::format("call {}", at)}, number(0));
          if (!calls) return std::optional<Variables>{};
          if (*calls) returns.push_back(command.next);
          at = *calls ? command.label : command.next;
          break;
        }
        case Flow::Call:
          returns.push_back(command.next);
          at = command.label;
          break;
        case Flow::Return:
          if (returns.empty()) return std::nullopt;
          at = returns.back();
          returns.pop_back();
          break;
        case Flow::End: return std::nullopt;
        default:
          if (!change(now, at)) return std::nullopt;
          at = command.next != kNone ? command.next : command.label;
      }
    }
    Variables kept;
    for (const uint32_t variable : kept_) kept[variable] = value_of(now, variable);
    return std::optional(std::move(kept));
  }

  bool change(Variables& now, size_t at) const {
    const Instruction& code = places_.graph.commands[at].code;
    const auto operand = [&](size_t n) { return static_cast<uint32_t>(code.operands[n]); };
    bool short_enough = true;
    const auto set = [&](uint32_t variable, Value value) {
      short_enough = short_enough && value.text.size() <= kLongText;
      now[variable] = std::move(value);
    };
    switch (code.opcode) {
      case Opcode::SetHH: set(operand(0), value_of(now, operand(1))); return short_enough;
      case Opcode::SetHK: set(operand(0), number(code.operands[1])); return short_enough;
      case Opcode::NotH: {
        const Value value = value_of(now, operand(1));
        set(operand(0), value.is_number ? number(~value.number) : texts(code, value, value));
        return short_enough;
      }
      case Opcode::BitSet:
      case Opcode::BitClear: {
        const Value value = value_of(now, operand(0));
        const uint32_t bit = uint32_t{1} << (operand(1) & 31), bits = static_cast<uint32_t>(value.number);
        set(operand(0), value.is_number ? number(code.opcode == Opcode::BitSet ? bits | bit : bits & ~bit) : texts(code, value, number(bit)));
        return short_enough;
      }
      case Opcode::BitMove:
      case Opcode::BitMoveNeg: {
        const Value to = value_of(now, operand(0)), from = value_of(now, operand(2));
        set(operand(0), {false, 0, fmt::format("({}.{} {} {}.{})", text_of(to), operand(1), static_cast<int>(code.opcode), text_of(from), operand(3))});
        return short_enough;
      }
      case Opcode::SetiLoad: {
        const Value from = value_of(now, operand(1));
        if (!from.is_number) return false;
        set(operand(0), value_of(now, static_cast<uint32_t>(from.number)));
        return short_enough;
      }
      case Opcode::SetiStore: {
        const Value to = value_of(now, operand(0));
        if (!to.is_number) return false;
        set(static_cast<uint32_t>(to.number), value_of(now, operand(1)));
        return short_enough;
      }
      case Opcode::Copy: {
        std::vector<Value> values;
        for (uint32_t n = 0; n < operand(2); ++n) values.push_back(value_of(now, operand(1) + n));
        for (uint32_t n = 0; n < operand(2); ++n) set(operand(0) + n, values[n]);
        return short_enough;
      }
      default: break;
    }
    const vm::Coding& row = vm::coding(code.opcode);
    if (row.writes == vm::Writes::First && row.operand_count > 1) {
      const Value to = value_of(now, operand(0));
      const Value other = row.kinds[1] == vm::OperandKind::Variable ? value_of(now, operand(1)) : number(code.operands[1]);
      set(operand(0), calculated(code, to, other));
      return short_enough;
    }
    for (const Span& span : places_.values.written_by(at)) {  // the unit answers
      if (span.last - span.first >= kMostOfOne) return false;
      for (int64_t v = span.first; v <= span.last; ++v) set(static_cast<uint32_t>(v), {false, 0, fmt::format("answer {} {}", at, v - span.first)});
    }
    return short_enough;
  }

  // None: it is open, and there are new cases that are not.
  std::optional<bool> compare(const Case& one, Opcode opcode, const Value& left, const Value& right) {
    if (left.is_number && right.is_number) return holds(opcode, left.number, right.number);
    // A value against a number, or the order of two of which nothing else is known.
    std::string text;
    Interval range;
    int64_t limit = 0;
    bool turned = false;
    if (!left.is_number && !right.is_number) {
      if (left == right) return holds(opcode, 0, 0);
      text = fmt::format("{} ? {}", left.text, right.text);
      range = {-1, 1};
    } else {
      turned = left.is_number;
      text = turned ? right.text : left.text;
      limit = turned ? left.number : right.number;
    }
    if (const auto known = one.assumed.find(text); known != one.assumed.end()) range = known->second;
    // Below, at and above the limit; what of the range lies there.
    std::vector<Interval> parts;
    for (const Interval& part : {Interval{range.least, std::min(range.most, limit - 1)},
                                 Interval{std::max(range.least, limit), std::min(range.most, limit)},
                                 Interval{std::max(range.least, limit + 1), range.most}})
      if (!part.is_empty()) parts.push_back(part);
    const auto answer = [&](const Interval& part) {
      const int64_t sign = part.most < limit ? -1 : part.least > limit ? 1 : 0;
      return turned ? holds(opcode, 0, sign) : holds(opcode, sign, 0);
    };
    const bool of_first = answer(parts.front());
    if (std::all_of(parts.begin(), parts.end(), [&](const Interval& part) { return answer(part) == of_first; })) return of_first;
    for (const Interval& part : parts) {
      Case made = one;
      made.assumed[text] = part;
      open_.push_back(std::move(made));
    }
    return std::nullopt;
  }

  static bool holds(Opcode opcode, int64_t a, int64_t b) {
    switch (opcode) {
      case Opcode::JmpEqHH:
      case Opcode::JmpEqHK: return a == b;
      case Opcode::JmpNeHH:
      case Opcode::JmpNeHK: return a != b;
      case Opcode::JmpLtHH:
      case Opcode::JmpLtHK: return a < b;
      case Opcode::JmpLeHH:
      case Opcode::JmpLeHK: return a <= b;
      case Opcode::JmpGtHH:
      case Opcode::JmpGtHK: return a > b;
      default: return a >= b;
    }
  }

  const Places& places_;
  const Turn& turn_;
  const std::set<uint32_t>& kept_;
  std::vector<Case> open_;
  uint64_t executed_ = 0;
};

}  // namespace

std::optional<uint64_t> turns_until_rest(const Places& places, const Turn& turn, const std::set<uint32_t>& kept) {
  return Settler(places, turn, kept).run();
}

}  // namespace ipos::compiler::analysis
