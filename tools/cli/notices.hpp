// The licence of ipos and those of the third parties in this program, as one text: `ipos --licences`, and the page.
// cmake/notices.cmake makes it of packaging/third_parties.tsv.
#pragma once

#include <span>
#include <string_view>

#include "stdlib/embedded.hpp"

namespace ipos::tools {
namespace notices {

std::span<const stdlib::EmbeddedFile> embedded_files();

}  // namespace notices

inline std::string_view notices_text() { return notices::embedded_files().front().text; }

}  // namespace ipos::tools
