// The FMUs that a user allows for good: lines of the file allow-fmu in the user's folder for settings, each the path of an FMU or
// of a folder, with # before a comment.
#pragma once

#include <string>

namespace ipos::tools {

bool is_allowed(const std::string& fmu);
// ", or for good by a line in FILE", for messages; empty where this user has no such folder.
std::string where_to_allow();

}  // namespace ipos::tools
