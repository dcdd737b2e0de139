// Sums of variables times constants, modulo 2^32 as the unit computes: the number of an element, or a value, that grows by a constant
// when one of its variables does.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "compiler/sema/checked.hpp"

namespace ipos::compiler {

struct Term {
  int32_t variable = 0;
  uint32_t factor = 0;
  bool operator==(const Term&) const = default;
};

struct Linear {
  static constexpr size_t kMostTerms = 3;  // no number of an element has more variables, and no loop allocates memory for them
  std::array<Term, kMostTerms> terms{};    // in rising order of the variables; behind the last one the factors are 0
  uint32_t constant = 0;

  bool is_constant() const { return terms.front().factor == 0; }
  uint32_t factor(int32_t variable) const;
  bool operator==(const Linear&) const = default;
};

// Nothing: it is no such sum, or one of more variables.
std::optional<Linear> linear(const checked::Expr& expr);
// The number of a place that is computed; of *p it is what p holds.
std::optional<Linear> linear(const checked::Place& place);

// i++, i -= 2, i = i + 3 of a variable with a fixed number. Null is none.
struct MoveBy {
  int32_t variable = 0;
  uint32_t by = 0;
};
std::optional<MoveBy> move_of(const checked::Expr* expr);

// i = 5
std::optional<std::pair<int32_t, int32_t>> constant_of(const checked::Expr* expr);

}  // namespace ipos::compiler
