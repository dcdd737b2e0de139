// Makes what the engines need of a program, and keeps it.
#include "runtime/unit/unit_program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/unit/program_shelf.hpp"
#include "stdlib/system_variables.hpp"
#include "vm/verify/writes.hpp"

namespace ipos::runtime {
namespace {

constexpr size_t kControlWord = stdlib::system_variable("ControlWord");

bool same(const vm::Limits& a, const vm::Limits& b) {
  return a.variables == b.variables && a.program_words == b.program_words && a.tasks == b.tasks && a.call_depth == b.call_depth;
}

}  // namespace

tl::expected<std::shared_ptr<const UnitProgram>, std::string> UnitProgram::of(std::vector<uint32_t> code, const vm::Limits& limits,
                                                                             const Execution& execution) {
  if (execution.shelf)
    if (auto known = execution.shelf->find(code, limits, execution)) return known;
  const std::shared_ptr<UnitProgram> made(new UnitProgram(std::move(code)));
  std::array<vm::Violation, 1> violations{};
  made->verified_ = vm::verify(made->code_, limits, violations).image;
  if (!made->verified_) {
    const vm::RuleInfo& rule = vm::info(violations[0].rule);
    return tl::unexpected(fmt::format("word {}: {} [{}]", violations[0].address, rule.meaning, rule.code));
  }
  made->may_order_ = vm::may_write(*made->verified_, kControlWord, kControlWord);
  made->fast_ = execution.fast;
  made->compiler_ = execution.compiler;
  if (execution.fast) {
    made->slots_.assign(vm::fast::Predecoded::slots_needed(made->code_.size()), {});
    made->predecoded_.emplace(*made->verified_, made->slots_);
    if (execution.compiler != nullptr) made->native_ = execution.compiler(*made->verified_);
  }
  if (execution.shelf) execution.shelf->put(made);
  return made;
}

std::shared_ptr<const UnitProgram> ProgramShelf::find(std::span<const uint32_t> code, const vm::Limits& limits,
                                                      const Execution& execution) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const auto& one) {
    return one->fast_ == execution.fast && one->compiler_ == execution.compiler && same(one->verified_->limits(), limits) &&
           std::equal(one->code_.begin(), one->code_.end(), code.begin(), code.end());
  });
  if (known == kept_.end()) return nullptr;
  kept_.splice(kept_.begin(), kept_, known);
  return kept_.front();
}

void ProgramShelf::put(std::shared_ptr<const UnitProgram> program) {
  const std::lock_guard lock(mutex_);
  kept_.push_front(std::move(program));
  if (kept_.size() > kKept) kept_.pop_back();
}

}  // namespace ipos::runtime
