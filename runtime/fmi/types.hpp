// What a signal is to a simulator: its type, unit, range and the words of its values. FMI 2.0 has whole numbers of 32 bits and
// without a unit, so what has a unit, digits behind the point or more than that is a Real in both versions.
#pragma once

#include <map>
#include <set>
#include <string>

#include "runtime/fmi/variables.hpp"

namespace ipos::fmi {

class Types {
 public:
  explicit Types(Variables& out) : out_(out) {}
  void add(const signals::Signal& signal, Causality causality);

 private:
  void make_real(Variable& variable);
  bool make_enumeration(Variable& variable);
  void use_unit(Variable& variable, const runtime::PhysicalUnit& unit);

  Variables& out_;
  std::map<std::string, size_t> enumerations_;
  std::set<std::string> units_;
};

}  // namespace ipos::fmi
