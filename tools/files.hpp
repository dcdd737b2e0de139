// Reading and writing whole files; "-" is standard input or output. Trouble is a Failure with the system's
// reason.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ipos::tools {

std::string read_file(const std::string& path);
std::optional<std::string> try_read_file(const std::string& path);  // nothing when it cannot be read
void write_file(const std::string& path, std::span<const uint8_t> bytes);

}  // namespace ipos::tools
