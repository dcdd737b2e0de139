// Files as the operating system has them, for files.cpp and outputs.cpp. tools/cli/posix and tools/cli/windows have a
// source each; where a function fails, errno says why.
#pragma once

#include <sys/stat.h>

#include <compare>
#include <cstdint>
#include <optional>
#include <string>

#include "runtime/os_port/descriptor.hpp"

namespace ipos::tools {

// Which file it is. A number of the file system is given again to the next file when this one is removed; the time at
// which the file was made, where the file system keeps it, tells the two apart.
struct FileIdentity {
  uint64_t device;
  uint64_t number;
  int64_t made_s;
  uint32_t made_ns;
  auto operator<=>(const FileIdentity&) const = default;
};
std::optional<FileIdentity> identity_of(const runtime::Descriptor& file);
std::optional<FileIdentity> identity_of(const std::string& path);

// What is there, behind links.
bool look_at(const std::string& path, struct stat& info);

// None of them blocks at a pipe.
runtime::Descriptor open_to_read(const std::string& path);
runtime::Descriptor open_to_write(const std::string& path);  // a device or a pipe with a reader
runtime::Descriptor open_new(const std::string& path);       // EEXIST where something is there

// A file that is being written is held; it is not written any more when nobody holds it and its process is gone.
void hold(const runtime::Descriptor& file);
bool is_written(const std::string& path, int64_t process);

// The file at `from` comes to the disk and takes the place of `to` in one step for everybody who looks, with the mode of
// what is there. False: it did not.
bool put_in_place(runtime::Descriptor file, const std::string& from, const std::string& to);

// Whether bytes of a file, a pipe or a socket, or their end, are there within so many milliseconds.
bool readable(int file, int milliseconds);

// A file that is gone when it is closed, and a new folder of this user, whose name begins so.
runtime::Descriptor open_without_name();
std::optional<std::string> make_folder(const std::string& beginning);

bool may_write(const std::string& path);
bool may_make_files_in(const std::string& folder);

}  // namespace ipos::tools
