// Which plant `ipos serve` means: a file, a folder with one plant, or nothing that can be told, and then the gallery opens.
#pragma once

#include <string>
#include <vector>

namespace ipos::tools::serve {

// The plants of a folder ("" is the current one); where there is none its programs.
std::vector<std::string> plants_in(const std::string& folder);

// The path of a plant, program or session. Empty: none was named, and the current folder has not just one. A Failure is what
// cannot be opened, with the name that was perhaps meant.
std::string find_plant(const std::string& named);

}  // namespace ipos::tools::serve
