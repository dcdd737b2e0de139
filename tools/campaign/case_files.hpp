// A case as files, for the page: its plant with the values of the case, and what the plant names.
#pragma once

#include <string>

#include "tools/campaign/subject.hpp"

namespace ipos::tools::campaign {

// Into a folder that is there; the path of what `ipos serve` takes: the plant, or the test.
std::string write_case(const std::string& folder, const Campaign& campaign, const CompileFlags& compile, const Levels& levels);

// `ipos serve` of that, in a new folder for temporary files.
int serve_case(const Campaign& campaign, const CompileFlags& compile, const Levels& levels, uint16_t port);

}  // namespace ipos::tools::campaign
