// System functions and standard structures as data, from system_functions.def and structures.def.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace ipos::stdlib {

struct SystemFunction {
  std::string_view name;       // as in C
  std::string_view mnemonic;   // of the IPOS command
  std::string_view arguments;  // kinds separated by spaces, see system_functions.def
  std::string_view meaning;
  std::string_view source;  // manual and page; empty: on no page read
};

// A member may have two names ("Format", "Len"); both mean the same variable.
struct Structure {
  std::string_view name;
  std::vector<std::vector<std::string_view>> members;  // in order of the variables; all names of each
  std::string_view source;
};

// What a member holds where it is no plain number: "number" of a variable, or the beginnings of its
// constants.
struct MemberUse {
  std::string_view structure;
  std::string_view member;
  std::string_view holds;

  bool holds_number() const { return holds == "number"; }
  std::vector<std::string_view> constants() const;  // beginnings of their names
};

std::span<const SystemFunction> system_functions();
std::span<const Structure> structures();

// nullptr when there is none. Function names in every accepted spelling.
const SystemFunction* find_system_function(std::string_view name);
const Structure* find_structure(std::string_view name);
std::span<const MemberUse> member_uses();
const MemberUse* find_member_use(std::string_view structure, std::string_view member);

}  // namespace ipos::stdlib
