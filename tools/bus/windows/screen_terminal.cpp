// The console and its keys.
#include "tools/bus/screen_terminal.hpp"

#include <conio.h>
#include <windows.h>

namespace ipos::tools {

struct ScreenKeys::Before {};

ScreenSize screen_size() {
  CONSOLE_SCREEN_BUFFER_INFO info{};
  if (GetConsoleScreenBufferInfo(GetStdHandle(STD_OUTPUT_HANDLE), &info) == 0) return {};
  return {static_cast<size_t>(info.srWindow.Right - info.srWindow.Left + 1),
          static_cast<size_t>(info.srWindow.Bottom - info.srWindow.Top + 1)};
}

ScreenKeys::ScreenKeys() {
  DWORD mode = 0;
  if (GetConsoleMode(GetStdHandle(STD_INPUT_HANDLE), &mode) != 0) before_ = std::make_unique<Before>();
}

ScreenKeys::~ScreenKeys() = default;

// The first of the two numbers of a key without a letter is no letter either.
std::optional<char> ScreenKeys::next() {
  if (!before_ || _kbhit() == 0) return std::nullopt;
  const int key = _getch();
  if (key != 0 && key != 0xE0) return static_cast<char>(key);
  _getch();
  return '\0';
}

}  // namespace ipos::tools
