// Which bytes of a reading are bad, on a system that does not mark them. Windows reports that something was wrong since the
// last question (ClearCommError), and puts a character of our choice in the place of a byte with a parity error
// (DCB::ErrorChar), if the driver does. So a byte of that value is bad when an error was reported, and good otherwise. A driver
// that reports an error and replaces nothing leaves it open which byte it was: then all of the reading are bad (ours), that
// their telegram is void, as it is at a station that sees parity.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ipos::runtime {

class ReplacedBytes {
 public:
  static constexpr uint8_t kReplacement = 0xA5;  // begins no telegram (ours)

  // The bytes as a terminal with PARMRK would give them (parity_marks.hpp). `reported`: an error since the reading before.
  std::string mark(std::string_view bytes, bool reported) {
    const bool found = (reported || reported_before_) && bytes.find(static_cast<char>(kReplacement)) != bytes.npos;
    const bool all = reported && !found;
    // The question may have come between the error and its byte, which is the next one then.
    reported_before_ = all;
    std::string marked;
    for (const char c : bytes) {
      const auto byte = static_cast<uint8_t>(c);
      if (all || (found && byte == kReplacement))
        marked += std::string("\xFF\0", 2) + c;
      else
        marked += byte == 0xFF ? std::string("\xFF\xFF") : std::string(1, c);
    }
    return marked;
  }

  static constexpr size_t kLongestMark = 3;

 private:
  bool reported_before_ = false;
};

}  // namespace ipos::runtime
