// Counts messages by kind.
#include "runtime/os_port/port_notes.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {

PortNotes::Kind* PortNotes::find(std::string_view text, bool& is_new) {
  const auto known =
      std::find_if(kinds_.begin(), kinds_.end(), [text](const Kind& kind) { return kind.text == text; });
  is_new = known == kinds_.end();
  if (!is_new) return &*known;
  if (kinds_.size() == kKinds) {
    ++beyond_;
    return nullptr;
  }
  return &kinds_.emplace_back(Kind{std::string(text)});
}

void PortNotes::note(std::string_view text) {
  bool is_new = false;
  if (find(text, is_new) != nullptr && is_new) fresh_.emplace_back(text);
}

void PortNotes::count(std::string_view kind, std::string_view sample) {
  bool is_new = false;
  Kind* found = find(kind, is_new);
  if (found == nullptr) return;
  ++found->times;
  if (is_new)
    fresh_.push_back(sample.empty() ? std::string(kind) : fmt::format("{}: '{}'", kind, escaped(sample)));
}

std::vector<std::string> PortNotes::repeats() const {
  std::vector<std::string> all;
  for (const Kind& kind : kinds_)
    if (kind.times > 1) all.push_back(fmt::format("{}: {} times", kind.text, kind.times));
  if (beyond_ != 0) all.push_back(fmt::format("messages of other kinds: {} times", beyond_));
  return all;
}

std::string escaped(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\\')
      text += "\\\\";
    else if (byte >= 0x20 && byte < 0x7F)
      text += c;
    else
      text += fmt::format("\\x{:02X}", byte);
  }
  return text;
}

}  // namespace ipos::runtime
