// A recording as one HTML file to look at in any browser: panels and strips as in the SVG, with zoom, two
// cursors and their values. It needs nothing but itself.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/recording/recording.hpp"

namespace ipos::tools {

std::string plot_html(const Recording& recording, const std::string& title);
// The same of signals that a file describes: `channels` are what channel_json() has said of them.
std::string plot_html_of(const Recording& recording, const std::vector<nlohmann::json>& channels, const std::string& title);

}  // namespace ipos::tools
