// Names in files of others, where fewer letters are allowed than here: what was cut or replaced may be equal to another
// one then, and gets a number after it.
#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>

#include <fmt/format.h>

namespace ipos::runtime {

class UniqueNames {
 public:
  explicit UniqueNames(size_t longest) : longest_(longest) {}

  // `name` is what became of `original`: nobody else has what is returned, and the same original gets the same again.
  const std::string& of(const std::string& original, const std::string& name) {
    const auto known = names_.find(original);
    if (known != names_.end()) return known->second;
    const std::string cut = name.substr(0, longest_);
    std::string unique = cut;
    for (size_t& n = last_[cut]; !taken_.insert(unique).second;) {
      const std::string number = fmt::format("_{}", ++n + 1);
      unique = cut.substr(0, longest_ - number.size()) + number;
    }
    return names_.emplace(original, std::move(unique)).first->second;
  }

 private:
  size_t longest_;
  std::map<std::string, std::string> names_;  // by original
  std::set<std::string> taken_;
  std::map<std::string, size_t> last_;  // number given for a name, so that many equal ones take no time
};

}  // namespace ipos::runtime
