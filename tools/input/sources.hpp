// The sources of the programs that this process has compiled, as they were then: what is shown beside a program is the
// text that runs, also where the file has changed since.
#pragma once

#include <optional>
#include <string>

namespace ipos::tools {

// Reads the file for the compiler and keeps its text, in place of what was kept of it before.
std::optional<std::string> read_source(const std::string& path);
void keep_source(const std::string& path, std::string text);

// As it was compiled. Of an image that was compiled elsewhere: as the file is when it is first asked for.
std::optional<std::string> source_text(const std::string& path);
// One line of it, from 1; empty where there is none.
std::string source_line(const std::string& path, size_t line);

// What source_text() gives is no longer what stands in the file.
bool source_has_changed(const std::string& path);

}  // namespace ipos::tools
