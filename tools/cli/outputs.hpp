// Files that verbs write. One that takes the place of another is written aside, brought to the disk and
// renamed, so that the old one or the new one is there, whole, whatever happens. "-" and "/dev/stdout" are
// standard output. Trouble is a Failure with its reason; so is an output that is an input of the same verb.
#pragma once

#include <cstdint>
#include <fstream>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>

namespace ipos::tools {

bool is_standard_output(const std::string& path);

// Replaces what stands there; links are followed, the mode is kept. Devices and pipes are written to.
void replace_file(const std::string& path, std::string_view bytes);
void replace_file(const std::string& path, std::span<const uint8_t> bytes);

// The same for what was read from there.
void rewrite_file(const std::string& path, std::string_view bytes);

// Before a long run: a Failure where replace_file() could not do it. An empty path is no output.
void check_output(const std::string& path);

// A log that others read while it grows: written in place, bit by bit. Closed for an empty path.
class LogOutput {
 public:
  explicit LogOutput(const std::string& path);
  bool is_open() const { return out_ != nullptr; }
  std::ostream& stream() { return *out_; }
  void flush();   // what was written can be read, or finish() tells that it cannot
  void finish();  // a Failure when not all is in the file

 private:
  std::string path_;
  std::ofstream file_;
  std::ostream* out_ = nullptr;
};

}  // namespace ipos::tools
