// What `ipos serve` keeps for its next start: small files in the user's state folder, which only this user can read
// (0700, 0600; on Windows as all of that folder). A file is the old one or the new one, whatever happens while it is written.
// posix and windows have what differs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace ipos::tools::serve {

constexpr size_t kLongestState = 512 * 1024;  // of a file: what is longer is neither written nor read

// The variable of the environment that names where the folder is.
extern const char* const kStateVariable;

// `$XDG_STATE_HOME/ipos`, else `~/.local/state/ipos`, on Windows `%LOCALAPPDATA%\ipos`; made where it is missing. Empty: this
// user has no such place.
std::filesystem::path state_folder();

// A name of a file there for something whose own name may have any characters, as a port or a path has: the kind in
// front, then what can be read of it, then a sum that tells two of them apart.
std::string state_name(std::string_view kind, std::string_view of);

// Nothing where there is none, where it is no plain file of this user, or where others may read or write it.
std::optional<std::string> read_state(const std::string& name);
// False: it could not be written, and the old one is there.
bool write_state(const std::string& name, std::string_view text);
// Of all who change this file one after the other; without a state folder it keeps nobody out.
class StateLock {
 public:
  explicit StateLock(const std::string& name);
  ~StateLock();
  StateLock(const StateLock&) = delete;
  StateLock& operator=(const StateLock&) = delete;

 private:
  std::intptr_t file_ = -1;
};
void remove_state(const std::string& name);

}  // namespace ipos::tools::serve
