// System functions and standard structures from their tables.
#include "stdlib/language_tables.hpp"

namespace ipos::stdlib {
namespace {

constexpr SystemFunction kFunctions[] = {
#define FUNCTION(name, mnemonic, arguments, meaning, source) {name, mnemonic, arguments, meaning, source},
#include "stdlib/system_functions.def"
};

struct Spelling {
  std::string_view other;
  std::string_view name;
};

constexpr Spelling kSpellings[] = {
#define FUNCTION(name, mnemonic, arguments, meaning, source)
#define SPELLING(other, name) {other, name},
#include "stdlib/system_functions.def"
};

constexpr MemberUse kMemberUses[] = {
#define MEMBER(structure, member, holds) {structure, member, holds},
#include "stdlib/members.def"
};

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

std::vector<Structure> make_structures() {
  std::vector<Structure> all;
  const auto add = [&all](std::string_view name, std::string_view members, std::string_view source) {
    Structure structure{name, {}, source};
    for (std::string_view member : split(members, ' ')) structure.members.push_back(split(member, '/'));
    all.push_back(std::move(structure));
  };
#define STRUCTURE(name, members, source) add(name, members, source);
#include "stdlib/structures.def"
  return all;
}

}  // namespace

std::span<const SystemFunction> system_functions() { return kFunctions; }

std::span<const Structure> structures() {
  static const std::vector<Structure> all = make_structures();
  return all;
}

const SystemFunction* find_system_function(std::string_view name) {
  for (const Spelling& spelling : kSpellings)
    if (spelling.other == name) name = spelling.name;
  for (const SystemFunction& function : kFunctions)
    if (function.name == name) return &function;
  return nullptr;
}

const Structure* find_structure(std::string_view name) {
  for (const Structure& structure : structures())
    if (structure.name == name) return &structure;
  return nullptr;
}

std::span<const MemberUse> member_uses() { return kMemberUses; }

std::vector<std::string_view> MemberUse::constants() const {
  return holds_number() ? std::vector<std::string_view>{} : split(holds, ' ');
}

const MemberUse* find_member_use(std::string_view structure, std::string_view member) {
  for (const MemberUse& use : kMemberUses)
    if (use.structure == structure && use.member == member) return &use;
  return nullptr;
}

}  // namespace ipos::stdlib
