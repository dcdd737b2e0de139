// Exit codes of `ipos`, after sysexits where it has one.
#pragma once

namespace ipos::tools {

inline constexpr int kGood = 0;
inline constexpr int kFindings = 1;       // test failed, drive fault, image refused
inline constexpr int kUsage = 64;         // wrong command line
inline constexpr int kBadInput = 65;      // the input has errors
inline constexpr int kNoInput = 66;       // the input cannot be read
inline constexpr int kInternal = 70;      // a defect of ipos
inline constexpr int kIoError = 74;       // output cannot be written
inline constexpr int kInterrupted = 130;  // Ctrl-C

}  // namespace ipos::tools
