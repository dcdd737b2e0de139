// Bytes go out as they are, without a carriage return in front of each line feed; a console takes UTF-8 and escape
// sequences.
#include "tools/cli/streams.hpp"

#include <fcntl.h>
#include <io.h>
#include <windows.h>

#include <cstdio>
#include <initializer_list>

namespace ipos::tools {

void prepare_streams() {
  for (FILE* stream : {stdin, stdout, stderr}) _setmode(_fileno(stream), _O_BINARY);
  setvbuf(stderr, nullptr, _IONBF, 0);  // a message is there when it is told, also in a file
  SetConsoleOutputCP(CP_UTF8);
  SetConsoleCP(CP_UTF8);
  for (const DWORD number : {STD_OUTPUT_HANDLE, STD_ERROR_HANDLE}) {
    const HANDLE console = GetStdHandle(number);
    DWORD mode = 0;
    if (GetConsoleMode(console, &mode) != 0)
      SetConsoleMode(console, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
  }
}

// Who starts a program for another one often gives it a window of its own, too, but not its streams.
bool has_own_window() {
  DWORD processes[2] = {}, mode = 0;
  const auto is_console = [&mode](DWORD number) { return GetConsoleMode(GetStdHandle(number), &mode) != 0; };
  return GetConsoleProcessList(processes, 2) == 1 && is_console(STD_INPUT_HANDLE) && is_console(STD_OUTPUT_HANDLE) &&
         is_console(STD_ERROR_HANDLE);
}

void wait_for_reader() {
  std::fputs("Press Enter to close this window.\n", stderr);
  while (const int c = std::getchar()) {
    if (c == '\n' || c == EOF) return;
  }
}

}  // namespace ipos::tools
