// A console, which edits its lines itself and gives them in UTF-16.
#include "tools/debug/line_input.hpp"

#include <fmt/format.h>
#include <windows.h>

#include <array>
#include <cstdio>

#include "tools/cli/interrupt.hpp"

namespace ipos::tools::debug {
namespace {

constexpr char kEnd = 0x1A;  // Ctrl-Z

std::string utf8_of(const wchar_t* text, DWORD count) {
  const int size = WideCharToMultiByte(CP_UTF8, 0, text, static_cast<int>(count), nullptr, 0, nullptr, nullptr);
  std::string bytes(static_cast<size_t>(size), '\0');
  WideCharToMultiByte(CP_UTF8, 0, text, static_cast<int>(count), bytes.data(), size, nullptr, nullptr);
  return bytes;
}

}  // namespace

std::optional<std::string> LineInput::next_typed() {
  const HANDLE console = GetStdHandle(STD_INPUT_HANDLE);
  forget_interrupt();
  for (;;) {
    if (auto line = line_of_rest()) return line;
    if (rest_.empty()) fmt::print("(ipos) ");
    std::fflush(stdout);
    std::array<wchar_t, 4096> typed{};
    DWORD count = 0;
    SetLastError(ERROR_SUCCESS);
    const bool read = ReadConsoleW(console, typed.data(), static_cast<DWORD>(typed.size()), &count, nullptr) != 0;
    if (GetLastError() == ERROR_OPERATION_ABORTED || interrupted()) {  // Ctrl-C; its event may come later than this
      for (int waited = 0; waited < 100 && !interrupted(); ++waited) Sleep(1);
      forget_interrupt();
      rest_.clear();
      fmt::print("\n");
      continue;
    }
    if (!read || count == 0) return std::nullopt;
    rest_ += utf8_of(typed.data(), count);
    if (rest_.starts_with(kEnd)) return std::nullopt;
  }
}

void LineInput::complete_with(Words) {}

}  // namespace ipos::tools::debug
