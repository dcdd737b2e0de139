// A plant file's text with other values, everything else as it was written: so that a case can be read, shown and opened like
// any plant.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::tools::campaign {

class TomlEdit {
 public:
  // It must be good TOML.
  explicit TomlEdit(std::string text) : text_(std::move(text)) {}

  // "bus.sbus.baud": of an array of tables the one with that name, or "stimulus.0.at", by its number. `toml`: the value as TOML writes it. Nothing when it was
  // done, else why not.
  std::optional<std::string> set(std::string_view path, std::string_view toml);
  void append(std::string_view text);

  const std::string& text() const { return text_; }
  // Where a line of the text stands in the one that was given; 0: it was added.
  uint32_t original_line(uint32_t line) const;

 private:
  void insert_line(uint32_t after, std::string_view line);

  std::string text_;
  std::vector<uint32_t> added_;  // lines, in the order in which they came
};

}  // namespace ipos::tools::campaign
