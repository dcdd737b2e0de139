// Processes by names that hold over machines, and files that are written whole. posix and windows have a source each.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/os_port/descriptor.hpp"

namespace ipos::tools::campaign {

// "machine process start": no two processes have the same.
std::string this_process();
bool is_own_process(const std::string& name);
// Nothing: it is on another machine, so that nobody knows.
std::optional<bool> is_alive(const std::string& name);

// False: errno says why.
bool write_whole(const runtime::Descriptor& file, std::string_view bytes);
// At its end; made where it is not there.
runtime::Descriptor open_to_append(const std::string& path);
bool cut(const runtime::Descriptor& file, size_t size);
bool bring_to_disk(const runtime::Descriptor& file);
void bring_folder_to_disk(const std::string& folder);

// This program with other arguments, to its end.
int run_again(const std::vector<std::string>& arguments);

}  // namespace ipos::tools::campaign
