// A constant keeps its name in the macros of its place: GO_WAIT given to _AxisStop can be told from the 1 it
// is.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/sema/variable_use.hpp"
#include "stdlib/language_tables.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::compiler {
namespace {

bool begins_with_any(std::string_view name, const std::vector<std::string_view>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](std::string_view beginning) { return name.starts_with(beginning); });
}

// A constant of the standard headers that is made for one purpose.
bool has_family(std::string_view name) {
  for (const vm::KeywordInfo& row : vm::keyword_table())
    if (row.constant == name) return true;
  for (const stdlib::MemberUse& use : stdlib::member_uses())
    if (!use.holds_number() && begins_with_any(name, use.constants())) return true;
  return false;
}

}  // namespace

void check_family(Context& context, Span constant, const std::vector<std::string_view>& wanted, int32_t value,
                  const std::string& place, const std::string& there) {
  // From the macro the number stands in outwards: `#define MODE GO_WAIT` is GO_WAIT, too.
  for (Location at = constant.begin; at.in_macro(); at = context.sources.expansion(at).use) {
    const std::string_view name = context.sources.expansion(at).macro;
    if (begins_with_any(name, wanted)) return;
    if (!has_family(name)) continue;
    context.diagnostics.report(Diag::ForeignConstant, constant,
                               {std::string(name), place, fmt::format("{}", value), there});
    return;
  }
}

}  // namespace ipos::compiler
