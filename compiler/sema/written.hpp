// Which variables a part of the program writes, with all functions that it calls.
#pragma once

#include <bitset>
#include <vector>

#include "compiler/sema/checked.hpp"
#include "compiler/sema/ranges.hpp"

namespace ipos::compiler {

using Numbers = std::bitset<kMaxNumbers>;

class Written {
 public:
  explicit Written(const checked::Program& program) : program_(program), of_(program.functions.size()) {}

  // What a pointer writes is not among it: whose number is taken must be looked up beside.
  void add(const checked::Stmt& stmt, Numbers& numbers);
  void add(const checked::Expr& expr, Numbers& numbers);
  const Numbers& of(size_t function);

 private:
  struct Function {
    bool known = false;
    Numbers numbers;
  };
  void add_one(const checked::Expr& expr, Numbers& numbers);

  const checked::Program& program_;
  std::vector<Function> of_;
};

}  // namespace ipos::compiler
