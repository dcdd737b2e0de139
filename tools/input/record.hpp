// A build that nobody prints: what was read for it, and what there is to say of it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/cli/told.hpp"

namespace ipos::tools {

struct BuildRecord {
  std::map<std::string, std::string> texts;  // by path
  std::vector<Told> messages;                // each once
  void tell(Told message);
};

}  // namespace ipos::tools
