// Where the files of an FMU lie, as importers tell it.
#pragma once

#include <string>
#include <string_view>

namespace ipos::fmi {

// FMI 2.0: "file:///tmp/a%20b/resources" is /tmp/a b/resources, "file:///C:/a" is C:/a under Windows. What has no scheme is a path.
// Empty: another scheme, or another machine.
std::string folder_of_uri(std::string_view uri);

}  // namespace ipos::fmi
