// Which of the kinds of TOML files of ipos a file is. What stands in it decides; where that could be two kinds, its name
// does. Every reader asks here, so that a file in the wrong place is told once, with the verb that takes it.
#pragma once

#include <cstdint>
#include <string_view>

namespace ipos::runtime {

enum class TomlKind : uint8_t {
  Plant,
  Test,
  Campaign,
  Parameters,
  Unknown  // nothing tells: its reader says what is missing
};

bool named_test(std::string_view path);      // *.test.toml
bool named_campaign(std::string_view path);  // *.campaign.toml

// Of a text that is no TOML its name decides alone.
TomlKind kind_of_text(std::string_view text, std::string_view path);

}  // namespace ipos::runtime
