// A set with more than kMost members is kAny: the analysis ends soon, and a message that lists five constants helps nobody.
// A program has thousands of sets, so each is looked up without a piece of memory of its own.
#include "compiler/sema/known_values.hpp"

#include <algorithm>

namespace ipos::compiler {
namespace {

uint64_t key_of(const KnownValue& known) {
  return uint64_t{static_cast<uint32_t>(known.value) ^ 0x80000000U} << 32 | known.span.begin.value;
}

}  // namespace

KnownValues::Set KnownValues::join(Set a, Set b) {
  if (a == b) return a;
  if (a == kAny || b == kAny) return kAny;
  if (a > b) std::swap(a, b);
  const auto [at, fresh] = joined_.emplace(uint64_t{a} << 32 | b, kAny);
  if (!fresh) return at->second;
  Members all = sets_[a];
  for (const KnownValue& known : values(b)) {
    auto* const end = all.known.begin() + all.count;
    auto* const place = std::find_if(all.known.begin(), end, [&](const KnownValue& one) { return key_of(one) >= key_of(known); });
    if (place != end && key_of(*place) == key_of(known)) continue;
    if (all.count == kMost) return kAny;
    std::move_backward(place, end, end + 1);
    *place = known;
    ++all.count;
  }
  return at->second = number_of(all);
}

const KnownValue* KnownValues::only(Set set) const {
  const std::span<const KnownValue> all = values(set);
  for (const KnownValue& known : all)
    if (known.value != all.front().value) return nullptr;
  return all.empty() ? nullptr : &all.back();
}

// Where it stands, or the free place where it would.
size_t KnownValues::place_of(const Members& members) const {
  uint64_t hash = members.count;
  for (size_t n = 0; n < members.count; ++n) hash = (hash ^ key_of(members.known[n])) * 0x9E3779B97F4A7C15U;
  const auto same = [&](Set set) {
    return std::equal(members.known.begin(), members.known.begin() + members.count, values(set).begin(), values(set).end(),
                      [](const KnownValue& a, const KnownValue& b) { return key_of(a) == key_of(b); });
  };
  size_t place = (hash >> 32) % table_.size();
  while (table_[place] != kAny && !same(table_[place])) place = (place + 1) % table_.size();
  return place;
}

KnownValues::Set KnownValues::number_of(const Members& members) {
  const size_t place = place_of(members);
  if (table_[place] != kAny) return table_[place];
  const auto number = static_cast<Set>(sets_.size());
  sets_.push_back(members);
  table_[place] = number;
  if (2 * sets_.size() > table_.size()) {
    table_.assign(4 * table_.size(), kAny);
    for (Set set = 1; set < sets_.size(); ++set) table_[place_of(sets_[set])] = set;
  }
  return number;
}

}  // namespace ipos::compiler
