// A script, or what a terminal gives in whole lines.
#include "tools/debug/line_input.hpp"

#include <unistd.h>

#include <cerrno>
#include <utility>

namespace ipos::tools::debug {

LineInput::LineInput() : terminal_(isatty(STDIN_FILENO) != 0) {}

std::optional<std::string> LineInput::next() {
  if (terminal_) return next_typed();
  for (;;) {
    if (auto line = line_of_rest()) return line;
    if (!read_more()) return rest_.empty() ? std::nullopt : std::optional(std::exchange(rest_, {}));
  }
}

bool LineInput::read_more() {
  char buffer[4096];
  const ssize_t count = read(STDIN_FILENO, buffer, sizeof buffer);
  if (count < 0 && errno == EINTR) return true;
  if (count <= 0) return false;
  rest_.append(buffer, static_cast<size_t>(count));
  return true;
}

std::optional<std::string> LineInput::line_of_rest() {
  const size_t end = rest_.find('\n');
  if (end == std::string::npos) return std::nullopt;
  std::string line = rest_.substr(0, end);
  if (line.ends_with('\r')) line.pop_back();
  rest_.erase(0, end + 1);
  return line;
}

}  // namespace ipos::tools::debug
