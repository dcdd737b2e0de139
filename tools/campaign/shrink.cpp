// Groups of failures.
#include "tools/campaign/shrink.hpp"

namespace ipos::tools::campaign {

std::string_view check_of(std::string_view failure) { return failure.substr(0, failure.find(": ")); }

void Groups::add(uint64_t rank, const std::vector<std::string>& failed) {
  if (failed.empty()) return;
  const std::string_view check = check_of(failed.front());
  auto known = groups_.find(check);
  if (known == groups_.end()) known = groups_.emplace(check, Group{0, rank, failed.front()}).first;
  Group& group = known->second;
  ++group.cases;
  if (rank >= group.first) return;
  group.first = rank;
  group.text = failed.front();
}

}  // namespace ipos::tools::campaign
