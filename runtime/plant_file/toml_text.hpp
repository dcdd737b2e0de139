// What must be looked at in a TOML text before the parser sees it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace ipos::runtime {

// Where something stands in a file, from 1; 0 when it does not stand there.
struct FilePlace {
  uint32_t line = 0;
  uint32_t column = 0;
};

struct TomlMistake {
  FilePlace place;
  std::string_view text;  // for the user
};

// What a mistake in a value's place is answered with.
inline constexpr std::string_view kWhatAValueIs =
    "a value is a number, true, false, a list, or a text in quotes";

// The first mistake for which toml++ 3.3 has undefined behaviour, so that it must not see it: a byte beyond ASCII
// outside of texts and comments, a text in quotes that begins in the middle of a word, a } where a list waits for a
// value, the name of a table that begins with no character of a key, a byte beyond ASCII after a backslash, a key of
// more parts than its stack may hold, and what begins as a date or a time. Nothing when there is none. TOML allows two
// of these: keys of any length, and dates and times, of which no key here takes one.
std::optional<TomlMistake> toml_mistake(std::string_view text);

// The text as the parser can take it: a character beyond ASCII that is the next one after a backslash that ends its
// line is written as its \U, which toml++ 3.3 reads right. Columns after it in that line are larger then.
std::string toml_for_parser(std::string_view text);

}  // namespace ipos::runtime
