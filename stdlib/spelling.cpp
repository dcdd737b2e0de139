// Edit distance with limits, so that long names and long lists stay cheap.
#include "stdlib/spelling.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace ipos::stdlib {
namespace {

constexpr size_t kLongest = 64;  // names beyond are not compared
constexpr size_t kMostSteps = 3;
constexpr size_t kShortPrefix = 4;  // letters that two names must share at least

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

size_t distance(std::string_view a, std::string_view b) {
  std::vector<size_t> before, last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  const auto same = [&](size_t i, size_t j) { return lower(a[i - 1]) == lower(b[j - 1]); };
  for (size_t i = 1; i <= a.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same(i, j) ? 0 : 1)});
      if (i > 1 && j > 1 && same(i, j - 1) && same(i - 1, j)) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

// The longest candidate the name begins with, else the shortest that begins with the name.
std::string_view by_prefix(std::string_view name, std::span<const std::string_view> candidates) {
  std::string_view shorter, longer;
  for (const std::string_view candidate : candidates) {
    const size_t common = std::min(name.size(), candidate.size());
    if (common < kShortPrefix || !equal_but_for_case(name.substr(0, common), candidate.substr(0, common)))
      continue;
    if (candidate.size() < name.size() && candidate.size() > shorter.size()) shorter = candidate;
    if (candidate.size() > name.size() && (longer.empty() || candidate.size() < longer.size()))
      longer = candidate;
  }
  return shorter.empty() ? longer : shorter;
}

}  // namespace

bool equal_but_for_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates) {
  if (name.size() > kLongest) return {};
  std::string_view best;
  size_t least = std::min(name.size() / 3, kMostSteps) + 1;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > name.size() + kMostSteps || candidate.size() + kMostSteps < name.size()) continue;
    const size_t steps = distance(name, candidate);
    if (steps < least) {
      least = steps;
      best = candidate;
    }
  }
  return best.empty() ? by_prefix(name, candidates) : best;
}

}  // namespace ipos::stdlib
