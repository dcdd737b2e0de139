// What the parts of the semantic check share while they work on one program.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "compiler/ast/ast.hpp"
#include "compiler/diag/diag.hpp"
#include "compiler/sema/call_graph.hpp"
#include "compiler/sema/checked.hpp"
#include "compiler/sema/scope.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::compiler {

// The first place of its kind in a function.
struct AccessPlace {
  size_t function;
  Span span;
  uint32_t into = UINT32_MAX;  // of a number that is taken: the variable it is assigned to, if that is all
};

// Functions (in the order they are checked) that read or write a variable, or take its number.
struct Access {
  std::vector<AccessPlace> readers;
  std::vector<AccessPlace> writers;
  std::vector<AccessPlace> takers;
};

// A constant assigned to a variable with a fixed number: what the SBus checks look at.
struct ConstantStore {
  uint32_t number;
  int32_t value;
  Span span;
};

// What is in the body of a function, outer ones first, in the order of the source. Many checks look at all of it.
struct Contents {
  std::span<const checked::Expr* const> expressions;
  std::span<const checked::Expr* const> calls;  // of them: calls of functions and commands
};

struct Context {
  const stdlib::UnitType& unit;
  const SourceMap& sources;
  Diagnostics& diagnostics;
  Scope scope;
  checked::Program program;
  std::unordered_map<uint32_t, Access> accesses;      // by variable number
  std::map<uint32_t, Span> raw_names;                 // first use of H5 and the like
  std::set<std::string, std::less<>> reported_names;  // unknown ones, each reported once
  std::vector<ConstantStore> stores;
  std::vector<AccessPlace> indirect = {};  // uses of a variable that is known at run time only
  std::vector<Contents> contents = {};     // of each function, when all are checked
  Arena lists = {};                        // where they are
  CallGraph graph = {};                    // then, too
  size_t function = SIZE_MAX;  // index of the function being checked
  size_t order = 0;            // its place among the declarations
  const ast::Program* tree = nullptr;
  bool overflown = false;      // a range has no room for all its variables, which was reported

  // False: the range has no room for the variable, so its number is that of others.
  bool has_room(const Variable& variable) const;
  // Marks H`number` as used by that name; false and a message when the unit has no such variable.
  // `name`: as written, of a number too large to be kept.
  bool use_raw(uint32_t number, Span span, std::string_view name);
};

}  // namespace ipos::compiler
