// The planted mistakes that no test has noticed, from the last `ipos test --mutate` to editors. A file for each source, in the
// user's cache, so that nothing is written among the programs.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::tools {

struct Survivor {
  uint32_t line = 0;  // from 1, as column
  uint32_t column = 0;
  std::string text;  // "< became <="
  bool reached = false;  // by a test

  bool operator==(const Survivor&) const = default;
};

// Of a source with this text; what was kept of it before is gone. A cache that cannot be written is no trouble of the tests.
void keep_survivors(const std::string& source, std::string_view text, const std::vector<Survivor>& survivors);

// None when the source has another text by now.
std::vector<Survivor> kept_survivors(const std::string& source, std::string_view text);

}  // namespace ipos::tools
