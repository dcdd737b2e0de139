// Failures that are alike, and the smallest case of each kind: factors go back to their middle value while it still fails so.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "tools/campaign/outline.hpp"

namespace ipos::tools::campaign {

// Which check a failure is of: what stands before the first ": ".
std::string_view check_of(std::string_view failure);

struct Group {
  uint64_t cases = 0;
  uint64_t first = 0;  // rank in the plan
  std::string text;    // of the first one
};
// By the first check that each case failed.
class Groups {
 public:
  void add(uint64_t rank, const std::vector<std::string>& failed);
  const std::map<std::string, Group, std::less<>>& all() const { return groups_; }

 private:
  std::map<std::string, Group, std::less<>> groups_;
};

// `fails`: whether a case fails alike.
template <typename Fails>
Levels shrunk(const Outline& outline, Levels levels, Fails fails) {
  for (bool again = true; again;) {
    again = false;
    for (size_t n = 0; n < levels.size(); ++n) {
      Levels smaller = levels;
      smaller[n] = outline.factors[n].middle();
      if (smaller == levels || !fails(smaller)) continue;
      levels = smaller;
      again = true;
    }
  }
  return levels;
}

}  // namespace ipos::tools::campaign
