// Names.
#include "tools/serve/state_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace ipos::tools::serve {
namespace {

constexpr size_t kReadablePart = 40;  // characters of a name, the last ones

}  // namespace

// FNV-1a, 64 bits: it need only tell the few files of one user apart.
std::string state_name(std::string_view kind, std::string_view of) {
  uint64_t sum = 0xCBF29CE484222325;
  for (const char c : of) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  std::string readable(of.substr(of.size() - std::min(of.size(), kReadablePart)));
  for (char& c : readable)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return fmt::format("{}-{}-{:016x}", kind, readable, sum);
}

}  // namespace ipos::tools::serve
