// Random expressions over the objects of a program: valid, terminating, and free of faults unless asked for.
#pragma once

#include <optional>

#include "tests/generated/objects.hpp"

namespace ipos::tests {

// What limits a program: nodes of the tree, and work when it runs.
struct Budget {
  int nodes = 0;
  uint64_t times = 1;               // how often the place being written is executed at most
  uint64_t cost = 0;                // of the function being written
  std::vector<uint64_t> functions;  // cost of those that may be called; 0: not written yet
};

class ExpressionGenerator {
 public:
  ExpressionGenerator(Pcg& random, const Objects& objects, Budget& budget, bool unguarded, int32_t variables)
      : random_(random), objects_(objects), budget_(budget), unguarded_(unguarded), variables_(variables) {}

  Expr value(int depth);
  // An expression for what it does; no part of it is discarded that has no effect.
  Expr effect(int depth);
  // Gives a variable a value that is worth computing with.
  Expr start_value(const Named& of);
  // A value that cannot fault and changes nothing.
  Expr pure(int depth);

  // Parts come in braces, as their random choices have to be made in order; arguments of a call have none.
  struct Two {
    Op op;
    Expr left;
    Expr right;
  };
  struct Pair {
    Expr left;
    Expr right;
  };
  struct Move {
    Expr what;
    int delta;
    bool prefix;
  };
  Expr binary(Two parts);
  Expr assign(Pair parts);
  Expr step(Move parts);
  Expr comma(Pair parts);

 private:
  Expr node(ExprKind kind, std::vector<Expr> parts);
  Expr leaf();
  Expr number();
  Expr numof();
  Expr target(int depth);  // a free variable
  Expr index(int32_t size, int depth);
  Expr pointer(int depth);                      // a value that is the number of a free variable
  Expr scalar();                                // one of the free variables with a name
  Expr constant(int depth);                     // numbers only
  Expr truth(int depth);                        // 0 or 1, compared with 0 or 1
  Expr entangled(const Expr& what, int depth);  // one operand changes the other
  Expr division(int depth);
  Expr copy();
  Expr bits();
  std::optional<Expr> call();
  Op arithmetic_operator();
  int inner(int depth);

  Pcg& random_;
  const Objects& objects_;
  Budget& budget_;
  bool unguarded_;
  int32_t variables_;
  bool pure_ = false;
};

}  // namespace ipos::tests
