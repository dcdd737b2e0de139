// What ipos keeps from one call to the next: small files in $XDG_CACHE_HOME/ipos, or ~/.cache/ipos, one for each kind and path.
#pragma once

#include <string>
#include <string_view>

namespace ipos::tools {

// `path` is what it is kept of. Long paths keep their end only, so the text says itself of which one it is.
std::string read_cache(std::string_view kind, const std::string& path);  // empty: nothing is kept
// Empty: it is removed. A cache that cannot be written is no trouble of its user.
void write_cache(std::string_view kind, const std::string& path, const std::string& text);

}  // namespace ipos::tools
