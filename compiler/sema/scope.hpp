// The names of a program: structure types, variables, aliases and functions, and what a name may have been
// meant to be.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "compiler/diag/diag.hpp"

namespace ipos::compiler {

struct StructType;

// long, or a structure; count 0: a single one, else an array.
struct Type {
  const StructType* structure = nullptr;
  uint32_t count = 0;

  bool scalar() const { return structure == nullptr && count == 0; }
  Type element() const { return {structure, 0}; }
  uint32_t size() const;
};

// "long", "SCREC", "long[8]"
std::string type_text(const Type& type);

// A member may have two names, see stdlib/structures.def.
struct StructMember {
  std::vector<std::string> names;
  Type type;
  uint32_t offset = 0;
  Span span;  // of the declaration; invalid in a standard structure
};

struct StructType {
  std::string name;
  std::vector<StructMember> members;
  uint32_t size = 0;  // variables; stops counting at kHugeSize
  Span span;          // invalid for standard structures

  const StructMember* find(std::string_view member) const;
};
inline constexpr uint32_t kHugeSize = 0xFFFF;

enum class Storage : uint8_t { Global, Initial, Alias };

struct Variable {
  std::string name;
  Type type;
  uint32_t number = 0;
  Storage storage = Storage::Global;
  Span span;
  size_t order = 0;  // place among the declarations
};

struct FunctionName {
  std::string name;
  size_t index = 0;
  Span span;
};

using Entity = std::variant<const StructType*, const Variable*, const FunctionName*>;

class Scope {
 public:
  Scope();

  // These report names that are taken or reserved and then return nullptr.
  StructType* add(StructType type, Diagnostics& diagnostics);
  Variable* add(Variable variable, Diagnostics& diagnostics);
  FunctionName* add(FunctionName function, Diagnostics& diagnostics);

  const Entity* find(std::string_view name) const;
  const StructType* find_type(std::string_view name) const;

  const std::deque<StructType>& types() const { return types_; }
  const std::deque<Variable>& variables() const { return variables_; }
  const std::deque<FunctionName>& functions() const { return functions_; }

  // Adds notes to a message about an unknown name: a similar name, or the header it comes with
  // (of MOVIDRIVE B: b_headers).
  void explain_unknown(Diagnostic& diagnostic, std::string_view name, bool function, bool b_headers) const;

 private:
  bool free_name(const std::string& name, Span span, Diagnostics& diagnostics) const;

  std::deque<StructType> types_;  // deques: entities stay where they are
  std::deque<Variable> variables_;
  std::deque<FunctionName> functions_;
  std::unordered_map<std::string_view, Entity> names_;  // by the name in the entity
};

// The number of H0, H007, ...; kHugeSize when it is larger than any variable number. False: no such name.
bool raw_number(std::string_view name, uint32_t& number);

}  // namespace ipos::compiler
