// The target of an assignment is the accumulator of its expression, unless somebody sees what it holds
// meanwhile.
#include "compiler/codegen/generator.hpp"

namespace ipos::compiler {

// Whether the expression has to be computed in a temporary. Where it is not although somebody looks on, that
// is noted.
bool FunctionGenerator::shows_steps(int32_t target) {
  if (is_temporary(target)) return false;
  if (acts_at_once(target)) return true;
  auto observer = program_.observers->find(function_, static_cast<uint32_t>(target), early_);
  if (!observer || options_.atomic) return observer.has_value();
  // What another root writes meanwhile is lost either way: W0258 says so.
  if (observer->writes_only && assignment_.reads_target) return false;
  std::vector<SeenSteps>& seen = code_.seen_steps;
  if (seen.empty() || seen.back().span != assignment_.span)
    seen.push_back({target, assignment_.span, std::move(*observer)});
  return false;
}

bool FunctionGenerator::stays(int32_t variable) const {
  return is_temporary(variable) ||
         (!acts_at_once(variable) && !program_.observers->may_change(function_, static_cast<uint32_t>(variable), early_));
}

bool FunctionGenerator::is_own(int32_t variable) const {
  return is_temporary(variable) ||
         (!acts_at_once(variable) && !program_.observers->find(function_, static_cast<uint32_t>(variable), early_));
}

}  // namespace ipos::compiler
