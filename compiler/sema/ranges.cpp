// Looks for a free run of variable numbers to advise a #pragma.
#include "compiler/sema/ranges.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

namespace ipos::compiler {
namespace {

// The highest run of `count` free numbers in an area.
std::optional<NumberRange> free_run(NumberRange area, uint32_t count, const std::bitset<kMaxNumbers>& taken) {
  uint32_t length = 0;
  for (uint32_t number = area.high + 1; number-- > area.low;) {
    length = taken.test(number) ? 0 : length + 1;
    if (length == count) return NumberRange{number, number + count - 1};
  }
  return std::nullopt;
}

}  // namespace

const char* pragma_name(RangeKind kind) {
  switch (kind) {
    case RangeKind::Globals: return "globals";
    case RangeKind::Initials: return "initials";
    case RangeKind::Temporaries: return "var";
  }
  return "";
}

const NumberRange& Ranges::of(RangeKind kind) const {
  return kind == RangeKind::Globals ? globals : kind == RangeKind::Initials ? initials : temporaries;
}

NumberRange& Ranges::of(RangeKind kind) { return const_cast<NumberRange&>(std::as_const(*this).of(kind)); }

std::string range_advice(RangeKind kind, uint32_t count, const Ranges& ranges,
                         const std::bitset<kMaxNumbers>& named, const stdlib::UnitType& unit) {
  std::bitset<kMaxNumbers> taken = named;
  for (const RangeKind other : {RangeKind::Globals, RangeKind::Initials, RangeKind::Temporaries}) {
    if (other == kind) continue;
    for (uint32_t n = ranges.of(other).low; n <= ranges.of(other).high; ++n) taken.set(n);
  }
  std::optional<NumberRange> run;
  if (kind == RangeKind::Initials) {
    run = free_run({0, kLastNonVolatile}, count, taken);
  } else {
    constexpr uint32_t kFirst = stdlib::kFirstSystemVariable, kLast = stdlib::kLastSystemVariable;
    run = free_run({kLastNonVolatile + 1, kFirst - 1}, count, taken);
    if (!run && unit.variables > kLast + 1) run = free_run({kLast + 1, unit.variables - 1U}, count, taken);
  }
  if (!run) return fmt::format("there are no {} free variables in a row", count);
  return fmt::format("'#pragma {} {} {}' makes room", pragma_name(kind), run->low, run->high);
}

}  // namespace ipos::compiler
