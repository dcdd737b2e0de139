// What the user is told about a port. A peer can cause a message as often as it likes, so the text of each
// kind is told once, the others are counted, and there is a limit to the kinds: memory stays bounded.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ipos::runtime {

class PortNotes {
 public:
  // A state: told once.
  void note(std::string_view text);

  // Something that happens again and again: the first of its kind is told, with what came (`sample`, any
  // bytes), the others are counted.
  void count(std::string_view kind, std::string_view sample = {});

  // What is new since the last call.
  std::vector<std::string> take() { return std::exchange(fresh_, {}); }

  // At the end: "KIND: 125203 times" for each that came more than once.
  std::vector<std::string> repeats() const;

 private:
  static constexpr size_t kKinds = 64;  // ours

  struct Kind {
    std::string text;
    uint64_t times = 0;  // of count() only
  };

  // Whether the kind is new; nothing beyond the limit.
  Kind* find(std::string_view text, bool& is_new);

  std::vector<Kind> kinds_;
  uint64_t beyond_ = 0;  // messages of kinds that found no room
  std::vector<std::string> fresh_;
};

// Bytes as a terminal may have them: what is not printable ASCII stands as \x1B, a backslash as two.
std::string escaped(std::string_view bytes);

}  // namespace ipos::runtime
