// A set with more than kMost members is kAny: the analysis ends soon, and a message that lists five constants helps nobody.
#include "compiler/sema/known_values.hpp"

#include <algorithm>

namespace ipos::compiler {

KnownValues::Set KnownValues::join(Set a, Set b) {
  if (a == b) return a;
  if (a == kAny || b == kAny) return kAny;
  if (a > b) std::swap(a, b);
  const uint64_t both = uint64_t{a} << 32 | b;
  if (const auto found = joined_.find(both); found != joined_.end()) return found->second;
  std::vector<KnownValue> all = sets_[a];
  for (const KnownValue& known : sets_[b]) all.push_back(known);
  return joined_[both] = add(std::move(all));
}

const KnownValue* KnownValues::only(Set set) const {
  const std::vector<KnownValue>& all = sets_[set];
  for (const KnownValue& known : all)
    if (known.value != all.front().value) return nullptr;
  return all.empty() ? nullptr : &all.back();
}

KnownValues::Set KnownValues::add(std::vector<KnownValue> values) {
  const auto key_of = [](const KnownValue& known) { return std::pair(known.value, known.span.begin.value); };
  std::sort(values.begin(), values.end(), [&](const KnownValue& a, const KnownValue& b) { return key_of(a) < key_of(b); });
  values.erase(std::unique(values.begin(), values.end(),
                           [&](const KnownValue& a, const KnownValue& b) { return key_of(a) == key_of(b); }),
               values.end());
  if (values.size() > kMost) return kAny;
  Key key;
  for (const KnownValue& known : values) key.push_back(key_of(known));
  const auto [at, fresh] = numbers_.emplace(std::move(key), static_cast<Set>(sets_.size()));
  if (fresh) sets_.push_back(std::move(values));
  return at->second;
}

}  // namespace ipos::compiler
