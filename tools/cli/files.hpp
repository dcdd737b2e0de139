// Reading whole files for every verb: regular files of bounded size, or refused at once. A device or a pipe
// could have no end, or block for ever.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/os_port/descriptor.hpp"

namespace ipos::tools {

// Far above any program, plant or image; logs of days may be long (ours).
inline constexpr size_t kInputLimit = size_t{64} << 20U;
inline constexpr size_t kLogLimit = size_t{1} << 30U;

// For a path that a user writes as an input: "-" and "/dev/stdin" are standard input, whatever that is.
// Trouble is a Failure with its reason.
std::string read_file(const std::string& path, size_t limit = kInputLimit);

// For a path that stands in another input; the error is why it cannot be read.
tl::expected<std::string, std::string> load_file(const std::string& path);
std::optional<std::string> try_read_file(const std::string& path);  // for those who do not ask why
std::optional<std::string> unreadable(const std::string& path);     // only why, or nothing

// The open file, or standard input, for those who read bit by bit.
runtime::Descriptor open_input(const std::string& path, size_t limit);

// False, too, where links lead nowhere.
bool is_folder(const std::string& path);

// The regular files in a folder and below, in order.
std::vector<std::string> files_below(const std::string& folder);

// Names of the files in a folder, "" being the current one; none when it cannot be read.
std::vector<std::string> list_files(const std::string& folder);

// The path of a file that another one names, relative to itself: without `..` where a folder before it says the same, so
// that reports can be matched with files.
std::string beside(const std::string& file, const std::string& name);

// Whether one of the functions above has opened this very file.
bool is_input(const std::string& path);

}  // namespace ipos::tools
