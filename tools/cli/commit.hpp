// Of which commit this program is, for --version. cmake/commit.cmake writes the source.
#pragma once

namespace ipos::tools {

extern const char* const kCommit;  // "ae2015f2a1", with + when files were changed; empty without a Git clone

}  // namespace ipos::tools
