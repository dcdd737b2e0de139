// A recording as one HTML file to look at in any browser: panels and strips as in the SVG, with zoom, two
// cursors and their values. It needs nothing but itself.
#pragma once

#include <string>

#include "tools/recording/recording.hpp"

namespace ipos::tools {

std::string plot_html(const Recording& recording, const std::string& title);

}  // namespace ipos::tools
