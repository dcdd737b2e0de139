// Which variables a part of the program writes, with all functions that it calls.
#pragma once

#include <bitset>
#include <vector>

#include "compiler/sema/context.hpp"
#include "compiler/sema/ranges.hpp"

namespace ipos::compiler {

using Numbers = std::bitset<kMaxNumbers>;

class Written {
 public:
  explicit Written(const Context& context);

  // What a pointer writes is not among it: whose number is taken must be looked up beside.
  void add(const checked::Stmt& stmt, Numbers& numbers) const;
  void add(const checked::Expr& expr, Numbers& numbers) const;
  const Numbers& of(size_t function) const { return of_[function]; }

  // Without what is within it or called.
  static void add_own(const checked::Expr& expr, Numbers& numbers);

 private:
  void add_whole(const checked::Expr& expr, Numbers& numbers) const;

  std::vector<Numbers> of_;
};

}  // namespace ipos::compiler
