// The terminal of the monitor's table: its size, and its keys, which do not wait for the end of a line.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

namespace ipos::tools {

struct ScreenSize {
  size_t columns = 100, rows = 24;  // where the terminal does not tell
};
ScreenSize screen_size();

class ScreenKeys {
 public:
  // Of standard input, if that is a terminal.
  ScreenKeys();
  // The terminal is as it was.
  ~ScreenKeys();
  ScreenKeys(const ScreenKeys&) = delete;
  ScreenKeys& operator=(const ScreenKeys&) = delete;

  // One that was pressed since the last time.
  std::optional<char> next();

 private:
  struct Before;  // null: no terminal
  std::unique_ptr<Before> before_;
};

}  // namespace ipos::tools
