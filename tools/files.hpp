// Reading and writing whole files; "-" is standard input or output. Trouble is a Failure with the system's
// reason.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ipos::tools {

std::string read_file(const std::string& path);
std::optional<std::string> try_read_file(const std::string& path);  // nothing when it cannot be read
// Names of the files in a folder, "" being the current one; none when it cannot be read.
std::vector<std::string> list_files(const std::string& folder);
void write_file(const std::string& path, std::span<const uint8_t> bytes);

// For what is written bit by bit. Nothing is opened for an empty path.
std::ofstream open_output(const std::string& path);
void close_output(std::ofstream& file, const std::string& path);

}  // namespace ipos::tools
