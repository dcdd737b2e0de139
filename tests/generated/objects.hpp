// The variables of a generated program: what it declares, and the numbers these must get.
#pragma once

#include <string>
#include <vector>

#include "tests/generated/pcg.hpp"
#include "tests/generated/program.hpp"

namespace ipos::tests {

// A variable with the text that names it.
struct Named {
  std::string text;
  int32_t number = 0;
};

// An array or structure variable.
struct Aggregate {
  std::string name;
  int32_t number = 0;
  int32_t size = 0;
  int type = -1;  // which structure type
};

struct Objects {
  std::vector<Named> scalars;     // free to take any value; members, raw Hn and aliases as well
  std::vector<Named> hot;         // a few of them, used more than the rest, so that uses of one variable meet
  std::vector<Aggregate> arrays;  // elements likewise
  std::vector<Aggregate> structures;
  std::vector<Named> pointers;  // hold the number of a free variable at all times; at first 0, as H0 is one
  std::vector<Named> counters;  // written by their own loop only
  std::vector<Expr> macros;     // #define of a value
};

Expr number_of(int32_t value);  // as decimal text; a negative one is a Unary
Expr variable_of(const Named& name);

// Chooses declarations and writes them to program.head. Names are valid for the unit and ranges of `program`.
Objects declare(Pcg& random, Program& program);

}  // namespace ipos::tests
