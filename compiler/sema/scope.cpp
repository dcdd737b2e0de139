// Names, types, and suggestions for misspelt names.
#include "compiler/sema/scope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "stdlib/header_names.hpp"
#include "stdlib/language_tables.hpp"
#include "stdlib/spelling.hpp"

namespace ipos::compiler {
namespace {

Span span_of(const Entity& entity) {
  return std::visit([](const auto* row) { return row->span; }, entity);
}

struct ForeignName {
  std::string_view name;
  std::string_view advice;
};
constexpr ForeignName kForeignFunctions[] = {
    {"memcpy", "'_Copy( to, from, n )' copies variables, and 'a = b;' a whole structure or array"},
    {"memmove", "'_Copy( to, from, n )' copies variables, and 'a = b;' a whole structure or array"},
    {"delay", "'_Wait( ms )' waits"},
    {"sleep", "'_Wait( ms )' waits"},
    {"usleep", "'_Wait( ms )' waits"},
    {"msleep", "'_Wait( ms )' waits"},
    {"abs", "write 'if (a < 0) a = -a;'"},
};
constexpr ForeignName kForeignNames[] = {
    {"true", "1 is true, as is any value except 0"}, {"false", "0 is false"}, {"null", "write 0"}, {"nullptr", "write 0"}};

// Flags of a PLC: MW10, DB5.
bool is_plc_memory(std::string_view name) {
  static constexpr std::string_view kAreas[] = {"M", "MB", "MW", "MD", "DB", "DBB", "DBW", "DBD"};
  const size_t digits = name.find_first_of("0123456789");
  return digits != std::string_view::npos && name.find_first_not_of("0123456789", digits) == std::string_view::npos &&
         std::find(std::begin(kAreas), std::end(kAreas), name.substr(0, digits)) != std::end(kAreas);
}

// What stands for a name of C or of a PLC language; nothing where it is none.
std::string foreign_advice(std::string_view name, bool function) {
  const std::span<const ForeignName> rows = function ? std::span<const ForeignName>(kForeignFunctions) : std::span<const ForeignName>(kForeignNames);
  for (const ForeignName& row : rows)
    if (stdlib::equal_but_for_case(name, row.name)) return std::string(row.advice);
  if (!function && is_plc_memory(name))
    return fmt::format("variables have the names that you declare, 'long {};', or their numbers, H10", name);
  return {};
}

}  // namespace

uint32_t Type::size() const {
  const uint64_t one = structure != nullptr ? structure->size : 1;
  return static_cast<uint32_t>(std::min<uint64_t>(one * std::max<uint32_t>(count, 1), kHugeSize));
}

std::string type_text(const Type& type) {
  std::string out = type.structure != nullptr ? type.structure->name : "long";
  if (type.count != 0) out += fmt::format("[{}]", type.count);
  return out;
}

const StructMember* StructType::find(std::string_view member) const {
  for (const StructMember& row : members)
    if (std::find(row.names.begin(), row.names.end(), member) != row.names.end()) return &row;
  return nullptr;
}

Scope::Scope() {
  for (const stdlib::Structure& standard : stdlib::structures()) {
    StructType type;
    type.name = standard.name;
    for (const auto& names : standard.members)
      type.members.push_back({{names.begin(), names.end()}, {}, type.size++, {}});
    StructType& row = types_.emplace_back(std::move(type));
    names_[row.name] = &row;
  }
}

bool Scope::free_name(const std::string& name, Span span, Diagnostics& diagnostics) const {
  uint32_t number = 0;
  std::string_view reason;
  const auto other = names_.find(name);
  if (raw_number(name, number)) reason = "a variable of the unit";
  if (stdlib::find_system_function(name) != nullptr) reason = "a system function";
  if (other != names_.end() && !span_of(other->second).begin.valid()) reason = "a standard structure";
  if (!reason.empty()) {
    diagnostics.report(Diag::ReservedName, span, {name, std::string(reason)});
    return false;
  }
  if (other == names_.end()) return true;
  diagnostics.report(Diag::Redefined, span, {name})
      .notes.push_back({span_of(other->second), "first declared here"});
  return false;
}

StructType* Scope::add(StructType type, Diagnostics& diagnostics) {
  if (!free_name(type.name, type.span, diagnostics)) return nullptr;
  StructType& row = types_.emplace_back(std::move(type));
  names_[row.name] = &row;
  return &row;
}

Variable* Scope::add(Variable variable, Diagnostics& diagnostics) {
  if (!free_name(variable.name, variable.span, diagnostics)) return nullptr;
  Variable& row = variables_.emplace_back(std::move(variable));
  names_[row.name] = &row;
  return &row;
}

FunctionName* Scope::add(FunctionName function, Diagnostics& diagnostics) {
  if (!free_name(function.name, function.span, diagnostics)) return nullptr;
  FunctionName& row = functions_.emplace_back(std::move(function));
  names_[row.name] = &row;
  return &row;
}

const Entity* Scope::find(std::string_view name) const {
  const auto found = names_.find(name);
  return found == names_.end() ? nullptr : &found->second;
}

const StructType* Scope::find_type(std::string_view name) const {
  const Entity* entity = find(name);
  if (entity == nullptr) return nullptr;
  const auto* type = std::get_if<const StructType*>(entity);
  return type == nullptr ? nullptr : *type;
}

void Scope::explain_unknown(Diagnostic& diagnostic, std::string_view name, bool function,
                            bool b_headers) const {
  const stdlib::HeaderName* known = stdlib::find_header_name(name, b_headers);
  if (known != nullptr) {
    uint32_t number = 0;
    const std::string what =
        raw_number(known->text, number) ? fmt::format("the system variable H{}", number)
        : known->text.starts_with('_')  ? std::string("a statement of the standard headers")
        : known->text.starts_with('(')  ? std::string("an input or output of the standard headers")
                                        : std::string("a constant of the standard headers");
    diagnostic.notes.push_back(
        {{}, fmt::format("'{}' is {}; '#include <{}>' makes it known", name, what, known->header)});
    return;
  }

  if (std::string advice = foreign_advice(name, function); !advice.empty()) {
    diagnostic.notes.push_back({{}, std::move(advice)});
    return;
  }

  std::vector<std::string_view> candidates;
  for (const auto& [declared, entity] : names_)
    if (std::holds_alternative<const FunctionName*>(entity) == function &&
        !std::holds_alternative<const StructType*>(entity))
      candidates.push_back(declared);
  std::sort(candidates.begin(), candidates.end());
  if (function) {
    for (const stdlib::SystemFunction& row : stdlib::system_functions()) candidates.push_back(row.name);
    candidates.push_back("numof");
  } else {
    for (const stdlib::HeaderName& row : stdlib::header_names()) candidates.push_back(row.name);
    for (const std::string_view word : {"break", "continue", "return"}) candidates.push_back(word);
  }
  // h5: a variable of the unit.
  uint32_t number = 0;
  const std::string capital = name.empty() ? "" : "H" + std::string(name.substr(1));
  if (!function && name.starts_with('h') && raw_number(capital, number)) candidates.push_back(capital);
  const std::string_view best = stdlib::nearest(name, candidates);
  if (best.empty()) return;
  const Entity* entity = find(best);
  diagnostic.notes.push_back(
      {entity != nullptr ? span_of(*entity) : Span{}, fmt::format("did you mean '{}'?", best)});
}

bool raw_number(std::string_view name, uint32_t& number) {
  if (name.size() < 2 || name[0] != 'H') return false;
  number = 0;
  for (const char c : name.substr(1)) {
    if (c < '0' || c > '9') return false;
    number = std::min(number * 10 + static_cast<uint32_t>(c - '0'), kHugeSize);
  }
  return true;
}

}  // namespace ipos::compiler
