// Exit codes of `ipos`, after sysexits where it has one.
#pragma once

#include <string_view>

namespace ipos::tools {

inline constexpr int kGood = 0;
inline constexpr int kFindings = 1;       // test failed, drive fault, image refused
inline constexpr int kUsage = 64;         // wrong command line
inline constexpr int kBadInput = 65;      // the input has errors
inline constexpr int kNoInput = 66;       // the input cannot be read
inline constexpr int kInternal = 70;      // a defect of ipos
inline constexpr int kIoError = 74;       // output cannot be written
inline constexpr int kTaken = 75;         // another process is at it
inline constexpr int kInterrupted = 130;  // Ctrl-C

// What they mean, for the manual page.
struct ExitCode {
  int code;
  std::string_view meaning;
};
inline constexpr ExitCode kExitCodes[] = {
    {kGood, "Good."},
    {kFindings, "Findings: a test failed, a drive has a fault, an image was refused."},
    {kUsage, "Wrong command line."},
    {kBadInput, "The input has errors."},
    {kNoInput, "The input cannot be read."},
    {kInternal, "A defect of ipos."},
    {kIoError, "Output cannot be written."},
    {kTaken, "Another runner has the shard of the campaign."},
    {kInterrupted, "Ended by Ctrl-C."},
};

}  // namespace ipos::tools
