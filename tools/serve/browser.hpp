// The user's browser; posix and windows have a source each.
#pragma once

#include <filesystem>

namespace ipos::tools::serve {

// Shows a file in it. It outlives this process, and nobody waits for it.
void show_in_browser(const std::filesystem::path& file);

}  // namespace ipos::tools::serve
