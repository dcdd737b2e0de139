// CAN identifiers as people read them: one form for all tables and lines, that of candump logs, and one for sentences,
// which also has the decimal number that programs and manuals write.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace ipos::runtime {

inline constexpr size_t kStandardIdDigits = 3, kExtendedIdDigits = 8;

// "12C"; an extended one has eight digits, as in candump logs.
std::string id_text(uint32_t id, bool extended = false);

// "12Ch (300)": a reader finds it in the log and in the program.
std::string id_words(uint32_t id, bool extended = false);

}  // namespace ipos::runtime
