// `for (i = 0; i < 10; i++) s += t[i].b;` keeps the number of t[i].b in a temporary that grows by 3 where i grows by 1, in place of SET, MUL
// and ADD in each turn. Only where nobody but the loop moves the variables of the number, and where the turns save more than the
// moves cost. i itself counts on: whoever looks at it sees what is written.
#include <algorithm>
#include <array>

#include "compiler/codegen/generator.hpp"

namespace ipos::compiler {

using checked::BinaryOp;

namespace {

constexpr size_t kMostNumbers = 8;

// The constant that the beginning of the loop gives a variable.
std::optional<int32_t> known_at_first(const checked::ExprPtr& init, int32_t variable) {
  const auto known = constant_of(init);
  return known && known->first == variable && !acts_at_once(variable) ? std::optional(known->second) : std::nullopt;
}

// A term that can be taken as it is comes first, then one that can be taken from a constant.
int order(const Term& term) { return term.factor == 1 ? 0 : term.factor == UINT32_MAX ? 1 : 2; }

}  // namespace

template <typename Node>
const FunctionGenerator::Held* FunctionGenerator::held(const Node& node) const {
  if (held_.empty()) return nullptr;
  const auto number = linear(node);
  const auto found = std::find_if(held_.begin(), held_.end(), [&](const Held& one) { return number && one.number == *number; });
  return found == held_.end() ? nullptr : &*found;
}
template const FunctionGenerator::Held* FunctionGenerator::held(const checked::Expr&) const;
template const FunctionGenerator::Held* FunctionGenerator::held(const checked::Place&) const;

// From a number that differs by a constant, where one is kept.
void FunctionGenerator::number_into(const checked::Place& place, int32_t target, Span span) {
  const auto number = held_.empty() ? std::nullopt : linear(place);
  for (const Held& one : held_) {
    if (!number || one.number.terms != number->terms) continue;
    set(target, {false, one.variable}, span);
    return operate(BinaryOp::Add, target, {true, static_cast<int32_t>(number->constant - one.number.constant)}, span);
  }
  into(*place.offset, target);
  operate(BinaryOp::Add, target, {true, place.number}, span);
}

bool FunctionGenerator::may_hold(const LoopScan& scan, const Linear& number) const {
  const auto is_held = [&](const Held& one) { return one.number == number; };
  return std::none_of(held_.begin(), held_.end(), is_held) &&
         std::all_of(number.terms.begin(), number.terms.end(), [&](const Term& term) { return term.factor == 0 || scan.moves_only(term.variable); });
}

// What it takes to compute the number once more: tried, and taken back.
size_t FunctionGenerator::commands_of(const LoopScan::Use& use) {
  const Hold hold(top_);
  const size_t before = code_.commands.size();
  const uint32_t temporaries = code_.temporaries;
  if (use.place != nullptr)
    address(*use.place, {});
  else
    into(*use.value, temporary());
  const size_t count = code_.commands.size() - before;
  code_.commands.resize(before);
  code_.temporaries = temporaries;
  return count;
}

void FunctionGenerator::hold_numbers(const LoopParts& loop) {
  if (options_.as_written || options_.most_held == 0) return;
  const LoopScan scan(loop, [this](int32_t variable) { return stays(variable); }, counters_);
  if (scan.counter()) counters_.push_back(*scan.counter());
  if (!scan.is_counted()) return;
  size_t room = std::min(options_.most_held, kMostNumbers);
  for (const LoopScan::Use& one : scan.uses()) {
    if (!may_hold(scan, one.number)) continue;
    // All that differ by a constant, which a statement moves by one ADD from one to the next.
    std::array<const Linear*, kMostNumbers> numbers{};
    size_t count = 0, now = 0;
    const LoopScan::Use* last = nullptr;
    for (const LoopScan::Use& use : scan.uses()) {
      if (use.number.terms != one.number.terms) continue;
      const bool goes_on = last != nullptr && use.assignment != nullptr && use.assignment == last->assignment;
      now += goes_on ? (use.number == last->number ? 0 : 1) : commands_of(use);
      const auto is_same = [&](const Linear* number) { return *number == use.number; };
      if (std::none_of(numbers.begin(), numbers.begin() + std::min(count, kMostNumbers), is_same) && count++ < kMostNumbers) numbers[count - 1] = &use.number;
      last = &use;
    }
    if (now <= count * scan.moves(one.number) || count > room) continue;
    room -= count;
    for (size_t n = 0; n < count; ++n) start_held(*numbers[n], loop);
  }
}

void FunctionGenerator::start_held(const Linear& number, const LoopParts& loop) {
  const Span span = (loop.init != nullptr ? loop.init : loop.condition)->span;
  const int32_t variable = temporary();
  uint32_t constant = number.constant;
  std::vector<Term> terms;  // of which those are first that are taken or added as they are
  for (const Term& term : number.terms) {
    if (const auto known = known_at_first(loop.init, term.variable))
      constant += term.factor * static_cast<uint32_t>(*known);
    else if (term.factor != 0)
      terms.insert(order(term) < (terms.empty() ? 0 : order(terms.front())) ? terms.begin() : terms.end(), term);
  }
  const auto near = std::find_if(held_.begin(), held_.end(), [&](const Held& one) { return one.number.terms == number.terms; });
  if (!terms.empty() && near != held_.end()) {
    constant = number.constant - near->number.constant;
    terms = {{near->variable, 1}};
  }
  const Hold hold(top_);
  const bool begins_with_constant = terms.empty() || terms.front().factor == UINT32_MAX;
  if (begins_with_constant) set(variable, {true, static_cast<int32_t>(constant)}, span);
  for (const Term& term : terms) {
    const bool first = &term == &terms.front() && !begins_with_constant;
    const bool is_taken = !first && term.factor == UINT32_MAX;
    const bool times = term.factor != 1 && !is_taken;
    const int32_t product = first ? variable : times ? temporary() : term.variable;
    set(product, {false, term.variable}, span);
    if (times) operate(BinaryOp::Mul, product, {true, static_cast<int32_t>(term.factor)}, span);
    if (!first) operate(is_taken ? BinaryOp::Sub : BinaryOp::Add, variable, {false, product}, span);
  }
  if (!begins_with_constant) operate(BinaryOp::Add, variable, {true, static_cast<int32_t>(constant)}, span);
  held_.push_back({number, variable});
  code_.holds_numbers = true;
}

void FunctionGenerator::move_held(const checked::Expr& expr) {
  if (held_.empty()) return;
  const auto move = move_of(&expr);
  if (!move) return;
  for (const Held& one : held_)
    operate(BinaryOp::Add, one.variable, {true, static_cast<int32_t>(one.number.factor(move->variable) * move->by)}, expr.span);
}

}  // namespace ipos::compiler
