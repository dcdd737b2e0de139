// A zip archive in memory (PKWARE APPNOTE 6.3): deflated files with names in UTF-8. The same files give the same bytes: no times of a
// clock, no owners.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace ipos::tools {

class Zip {
 public:
  // `name` with slashes, below the archive.
  void add(const std::string& name, std::string_view bytes, bool executable = false);
  std::string finish();

 private:
  std::string files_;
  std::string directory_;
  uint32_t count_ = 0;
};

}  // namespace ipos::tools
