// Every kind of expression of the language, effects inside operands included.
#include "tests/generated/expression_generator.hpp"

#include <algorithm>
#include <cstdio>

namespace ipos::tests {

Expr ExpressionGenerator::node(ExprKind kind, std::vector<Expr> parts) {
  --budget_.nodes;
  budget_.cost += budget_.times;
  Expr out;
  out.kind = kind;
  out.parts = std::move(parts);
  out.compact = random_.one_in(4);
  return out;
}

Expr ExpressionGenerator::binary(Two parts) {
  Expr out = node(ExprKind::Binary, {std::move(parts.left), std::move(parts.right)});
  out.op = parts.op;
  return out;
}

Expr ExpressionGenerator::assign(Pair parts) {
  return node(ExprKind::Assign, {std::move(parts.left), std::move(parts.right)});
}

Expr ExpressionGenerator::step(Move parts) {
  Expr out = node(ExprKind::Step, {std::move(parts.what)});
  out.value = parts.delta;
  out.prefix = parts.prefix;
  return out;
}

Expr ExpressionGenerator::comma(Pair parts) {
  return node(ExprKind::Comma, {std::move(parts.left), std::move(parts.right)});
}

int ExpressionGenerator::inner(int depth) { return budget_.nodes <= 0 ? 0 : depth - random_.between(1, 2); }

Expr ExpressionGenerator::number() {
  static constexpr int32_t kSpecial[] = {0,  0,  1,   1,   2,    3,     7,     10,       31,
                                         32, 33, 255, 256, 1000, 65535, 65536, INT32_MAX};
  const int form = random_.below(10);
  const int narrower = random_.below(32);
  const auto any = static_cast<int32_t>(random_.next() >> narrower);
  char text[48];
  Expr out = number_of(form < 6 ? kSpecial[random_.below(17)] : any & INT32_MAX);
  if (form == 5) out.text = "00" + out.text;  // decimal all the same
  if (form == 7) {
    out.value = any;
    std::snprintf(text, sizeof text, random_.one_in(2) ? "0x%X" : "0x%08x", static_cast<uint32_t>(any));
    out.text = text;
  } else if (form == 8) {
    out.text = "0b";
    for (int bit = 5; bit >= 0; --bit) out.text += (out.value >> bit & 1) != 0 ? '1' : '0';
    out.value &= 63;
  } else if (form == 9) {
    out = random_.one_in(3) ? number_of(static_cast<int32_t>(random_.next() | 0x8000'0001U)) : number_of(-1);
  }
  return out;
}

Expr ExpressionGenerator::numof() {
  Expr out = node(ExprKind::Numof, {});
  const int form = random_.below(4);
  if (form == 0 && !objects_.arrays.empty()) {
    const Aggregate& of = random_.pick(objects_.arrays);
    out.text = of.name;
    out.value = of.number;
  } else if (form == 1 && !objects_.structures.empty()) {
    const Aggregate& of = random_.pick(objects_.structures);
    out.text = of.name;
    out.value = of.number;
  } else {
    const Named& of = random_.pick(objects_.scalars);
    out.text = of.text;
    out.value = of.number;
  }
  return out;
}

Expr ExpressionGenerator::scalar() {
  return variable_of(random_.one_in(3) ? random_.pick(objects_.scalars) : random_.pick(objects_.hot));
}

Expr ExpressionGenerator::start_value(const Named& of) {
  return assign({variable_of(of), random_.one_in(2) ? number() : number_of(random_.between(-20, 20))});
}

Expr ExpressionGenerator::constant(int depth) {
  if (depth <= 0) return random_.one_in(3) ? number_of(random_.between(-20, 40)) : number();
  const int form = random_.below(8);
  if (form < 4) return binary({arithmetic_operator(), constant(depth - 1), constant(depth - 1)});
  if (form == 4)
    return binary({static_cast<Op>(static_cast<int>(Op::Eq) + random_.below(6)), constant(depth - 1),
                   constant(depth - 1)});
  if (form == 5) {
    int32_t divisor = random_.between(-7, 7);
    if (divisor == 0) divisor = -1;
    return binary({random_.one_in(2) ? Op::Div : Op::Mod, constant(depth - 1), number_of(divisor)});
  }
  if (form == 6)
    return binary({random_.one_in(2) ? Op::LogicalAnd : Op::LogicalOr, constant(depth - 1), constant(0)});
  Expr out = node(ExprKind::Unary, {constant(depth - 1)});
  out.op = static_cast<Op>(static_cast<int>(Op::Plus) + random_.below(4));
  return out;
}

Expr ExpressionGenerator::truth(int depth) {
  Expr what = random_.one_in(3) ? binary({random_.one_in(2) ? Op::LogicalAnd : Op::LogicalOr,
                                          value(inner(depth)), value(inner(depth))})
                                : binary({static_cast<Op>(static_cast<int>(Op::Eq) + random_.below(6)),
                                          value(inner(depth)), value(inner(depth))});
  return binary({random_.one_in(2) ? Op::Eq : Op::Ne, std::move(what), number_of(random_.below(2))});
}

Expr ExpressionGenerator::leaf() {
  --budget_.nodes;
  budget_.cost += budget_.times;
  const int form = random_.below(20);
  if (form < 5) return number();
  if (form == 5) return numof();
  if (form == 6) return random_.pick(objects_.macros);
  if (form == 7) return variable_of(random_.pick(objects_.counters));
  if (form == 8) return variable_of(random_.pick(objects_.pointers));
  return scalar();
}

// A power of two is masked, so that negative values work too; else the remainder of something not negative.
Expr ExpressionGenerator::index(int32_t size, int depth) {
  if (random_.one_in(4)) return number_of(random_.below(size));
  if (unguarded_ && !pure_ && random_.one_in(12))
    return binary({Op::Or, binary({Op::And, scalar(), number_of(1023)}), number_of(variables_)});
  if ((size & (size - 1)) == 0) return binary({Op::And, value(depth), number_of(size - 1)});
  return binary({Op::Mod, binary({Op::And, value(depth), number_of(0x7FFF)}), number_of(size)});
}

Expr ExpressionGenerator::pointer(int depth) {
  const int form = depth <= 0 ? random_.below(4) : random_.below(9);
  if (unguarded_ && !pure_ && random_.one_in(12)) {
    Expr beside = binary({Op::And, scalar(), number_of(1023)});
    if (random_.one_in(2)) return binary({Op::Sub, number_of(-1), std::move(beside)});
    return binary({Op::Or, std::move(beside), number_of(variables_)});
  }
  if (form < 3) return variable_of(random_.pick(objects_.pointers));
  if (form == 3) return numof();
  if (form == 4 && !pure_)
    return assign({variable_of(random_.pick(objects_.pointers)), pointer(inner(depth))});
  if (form == 5)
    return node(ExprKind::Conditional, {value(inner(depth)), pointer(inner(depth)), pointer(inner(depth))});
  if (form == 6 && !pure_) return comma({effect(inner(depth)), pointer(inner(depth))});
  if (form == 7) {
    const Named& of = random_.pick(objects_.pointers);
    Expr number = node(ExprKind::Numof, {});
    number.text = of.text;
    number.value = of.number;
    return node(ExprKind::Deref, {std::move(number)});
  }
  if (objects_.arrays.empty()) return numof();
  const Aggregate& of = random_.pick(objects_.arrays);
  Expr number = node(ExprKind::Numof, {});
  number.text = of.name;
  number.value = of.number;
  Expr offset = index(of.size, inner(depth));
  if (random_.one_in(2)) std::swap(number, offset);
  return binary({Op::Add, std::move(number), std::move(offset)});
}

Expr ExpressionGenerator::target(int depth) {
  const int form = depth <= 0 ? 0 : random_.below(8);
  if (form == 6 && !objects_.arrays.empty()) {
    const Aggregate& of = random_.pick(objects_.arrays);
    Expr out = node(ExprKind::Element, {index(of.size, inner(depth))});
    out.text = of.name;
    out.value = of.number;
    return out;
  }
  if (form >= 6) return node(ExprKind::Deref, {pointer(inner(depth))});
  return scalar();
}

Op ExpressionGenerator::arithmetic_operator() {
  static constexpr Op kOps[] = {Op::Add, Op::Sub, Op::Mul, Op::Shl, Op::Shr, Op::And, Op::Xor, Op::Or};
  return kOps[random_.below(8)];
}

// A divisor that is odd, or a division behind a test of its divisor.
Expr ExpressionGenerator::division(int depth) {
  const Op op = random_.one_in(2) ? Op::Div : Op::Mod;
  if (unguarded_ && !pure_ && random_.one_in(3))
    return binary({op, value(inner(depth)), value(inner(depth))});
  if (random_.one_in(2))
    return binary({op, value(inner(depth)), binary({Op::Or, value(inner(depth)), number_of(1)})});
  const Expr by = scalar();
  Expr quotient = binary({op, pure(inner(depth)), by});
  const int form = random_.below(3);
  if (form == 0) return binary({Op::LogicalAnd, by, std::move(quotient)});
  if (form == 1) return binary({Op::LogicalOr, binary({Op::Eq, by, number_of(0)}), std::move(quotient)});
  return node(ExprKind::Conditional,
              {binary({Op::Ne, by, number_of(0)}), std::move(quotient), value(inner(depth))});
}

Expr ExpressionGenerator::entangled(const Expr& what, int depth) {
  Expr change;
  const int form = random_.below(3);
  if (form == 0) {
    change = step({what, random_.one_in(2) ? 1 : -1, random_.one_in(2)});
  } else {
    change = assign({what, value(inner(depth))});
    if (form == 1) {
      change.compound = true;
      change.op = arithmetic_operator();
    }
  }
  const Op op = random_.one_in(3) ? static_cast<Op>(static_cast<int>(Op::Eq) + random_.below(6))
                                  : arithmetic_operator();
  if (random_.one_in(3)) change = binary({arithmetic_operator(), std::move(change), value(inner(depth))});
  if (random_.one_in(3)) return binary({op, std::move(change), what});
  return binary({op, what, std::move(change)});
}

Expr ExpressionGenerator::pure(int depth) {
  const bool outside = pure_;
  pure_ = true;
  Expr out = value(depth);
  pure_ = outside;
  return out;
}

Expr ExpressionGenerator::value(int depth) {
  if (depth <= 0 || budget_.nodes <= 0) return leaf();
  const int form = random_.below(pure_ ? 27 : 41);
  const auto in = [&] { return value(inner(depth)); };
  Expr out;
  if (form < 8) {
    out = binary({arithmetic_operator(), in(), in()});
  } else if (form < 12) {
    out = binary({static_cast<Op>(static_cast<int>(Op::Eq) + random_.below(6)), in(), in()});
  } else if (form < 15) {
    out = binary({random_.one_in(2) ? Op::LogicalAnd : Op::LogicalOr, in(), in()});
  } else if (form < 17) {
    out = division(depth);
  } else if (form < 20) {
    out = node(ExprKind::Unary, {in()});
    out.op = static_cast<Op>(static_cast<int>(Op::Plus) + random_.below(4));
  } else if (form < 22) {
    out = node(ExprKind::Conditional, {in(), in(), in()});
  } else if (form == 22) {  // one bit, as io.h tests an input
    out = binary({Op::And, binary({Op::Shr, in(), number_of(random_.below(32))}), number_of(1)});
  } else if (form < 24) {
    out = target(depth);
  } else if (form == 24) {
    out = truth(depth);
  } else if (form < 27) {
    out = constant(random_.between(1, 2));
  } else if (form < 30) {
    out = step({target(inner(depth)), random_.one_in(2) ? 1 : -1, random_.one_in(2)});
  } else if (form < 32) {
    out = comma({effect(inner(depth)), in()});
  } else if (form < 35) {
    out = assign({target(inner(depth)), in()});
  } else if (form < 39) {
    out = node(ExprKind::Assign, {target(inner(depth)), in()});
    out.compound = true;
    out.op = arithmetic_operator();
  } else {
    out = entangled(scalar(), depth);
  }
  out.parentheses = random_.one_in(8);
  return out;
}

std::optional<Expr> ExpressionGenerator::call() {
  std::vector<int> possible;
  for (size_t i = 0; i < budget_.functions.size(); ++i)
    if (budget_.functions[i] != 0 && budget_.cost + budget_.functions[i] * budget_.times < 20'000)
      possible.push_back(static_cast<int>(i));
  if (possible.empty()) return std::nullopt;
  Expr out = node(ExprKind::Call, {});
  out.value = random_.pick(possible);
  budget_.cost += budget_.functions[static_cast<size_t>(out.value)] * budget_.times;
  return out;
}

// Structures to each other, or a part of an array to another place of it, which may overlap.
Expr ExpressionGenerator::copy() {
  Expr out = node(ExprKind::CopyBlock, {});
  if (objects_.structures.empty() || (random_.one_in(2) && !objects_.arrays.empty())) {
    const Aggregate& of = random_.pick(objects_.arrays);
    const int32_t to = random_.below(of.size), from = random_.below(of.size);
    const int32_t count = random_.between(1, of.size - std::max(to, from));
    out.numbers = {of.number + to, of.number + from, count, 0};
    out.text = "_Copy(" + of.name + "[" + std::to_string(to) + "], " + of.name + "[" + std::to_string(from) +
               "], " + std::to_string(count) + ")";
    return out;
  }
  const Aggregate& to = random_.pick(objects_.structures);
  const Aggregate& from = random_.pick(objects_.structures);
  const bool same = to.type == from.type;
  const int32_t count = same ? to.size : std::min(to.size, from.size);
  out.numbers = {to.number, from.number, count, 0};
  if (same && random_.one_in(2))
    out.text = to.name + " = " + from.name;
  else
    out.text = "_Copy(" + to.name + ", " + from.name + ", " + std::to_string(count) + ")";
  return out;
}

Expr ExpressionGenerator::bits() {
  static constexpr const char* kNames[] = {"_BitSet", "_BitClear", "_BitMove", "_BitMoveNeg"};
  const int which = random_.below(4);
  const Expr to = scalar(), from = scalar();
  Expr out = node(ExprKind::Bits, {});
  out.op = static_cast<Op>(static_cast<int>(Op::BitSet) + which);
  out.numbers = {to.value, random_.below(32), from.value, random_.below(32)};
  out.text = std::string(kNames[which]) + "(" + to.text + ", " + std::to_string(out.numbers[1]);
  if (which >= 2) out.text += ", " + from.text + ", " + std::to_string(out.numbers[3]);
  out.text += ")";
  return out;
}

Expr ExpressionGenerator::effect(int depth) {
  const int form = random_.below(25);
  if (form == 24) {
    const Expr what = scalar();
    return assign({what, entangled(what, depth)});
  }
  if (form < 10) return assign({target(depth), value(depth)});
  if (form < 14) {
    Expr out = node(ExprKind::Assign, {target(depth), value(depth)});
    out.compound = true;
    out.op = arithmetic_operator();
    if (random_.one_in(4)) {
      out.op = random_.one_in(2) ? Op::Div : Op::Mod;
      if (!unguarded_ || random_.one_in(2))
        out.parts[1] = binary({Op::Or, std::move(out.parts[1]), number_of(1)});
    }
    return out;
  }
  if (form < 16) return step({target(depth), random_.one_in(2) ? 1 : -1, random_.one_in(2)});
  if (form == 16) return comma({effect(depth - 1), effect(depth - 1)});
  if (form == 17 && depth > 0)
    return node(ExprKind::Conditional, {value(inner(depth)), effect(inner(depth)), effect(inner(depth))});
  if (form == 18)
    return random_.one_in(2) || (objects_.structures.empty() && objects_.arrays.empty()) ? bits() : copy();
  if (form < 22) {
    if (std::optional<Expr> out = call()) return *out;
  }
  return assign({variable_of(random_.pick(objects_.pointers)), pointer(depth)});
}

}  // namespace ipos::tests
