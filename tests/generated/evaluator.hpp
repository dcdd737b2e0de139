// The first oracle: a reference evaluator over the generator's tree. Operands are evaluated strictly from
// left to right; the place of an assignment comes before its value, and the old value of a compound one too.
#pragma once

#include "tests/generated/program.hpp"

namespace ipos::tests {

// One operator on two values; nothing but Div and Mod can fail, and only with b == 0.
struct Applied {
  bool fault = false;
  int32_t value = 0;
};
Applied apply(Op op, int32_t a, int32_t b);

// `steps` bounds the expressions evaluated; beyond it the outcome has not ended.
Outcome evaluate(const Program& program, uint64_t steps = 2'000'000);

}  // namespace ipos::tests
