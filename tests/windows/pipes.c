/* Starts a program with pipes of Windows as standard input and output, and carries the bytes between them and its own. wine
   cannot look into a pipe of Linux (PeekNamedPipe), which Windows can, so what reads requests while it works gets one of these.
   pipes.exe PROGRAM WORD... */
#include <windows.h>
#include <wchar.h>

static HANDLE to_program, from_program;

static void carry(HANDLE from, HANDLE to) {
  char bytes[65536];
  DWORD count, done;
  while (ReadFile(from, bytes, sizeof bytes, &count, NULL) && count != 0)
    for (DWORD at = 0; at < count; at += done)
      if (!WriteFile(to, bytes + at, count - at, &done, NULL)) return;
}

static DWORD WINAPI carry_input(void* unused) {
  (void)unused;
  carry(GetStdHandle(STD_INPUT_HANDLE), to_program);
  CloseHandle(to_program);
  return 0;
}

static DWORD WINAPI carry_output(void* unused) {
  (void)unused;
  carry(from_program, GetStdHandle(STD_OUTPUT_HANDLE));
  return 0;
}

int main(void) {
  SECURITY_ATTRIBUTES inherited = {sizeof inherited, NULL, TRUE};
  HANDLE input, output;
  if (!CreatePipe(&input, &to_program, &inherited, 0) || !CreatePipe(&from_program, &output, &inherited, 0)) return 70;
  SetHandleInformation(to_program, HANDLE_FLAG_INHERIT, 0);
  SetHandleInformation(from_program, HANDLE_FLAG_INHERIT, 0);
  /* The words behind our own name, as they were given. */
  wchar_t* words = GetCommandLineW();
  words = *words == L'"' ? wcschr(words + 1, L'"') + 1 : wcschr(words, L' ');
  while (words != NULL && *words == L' ') ++words;
  STARTUPINFOW start = {.cb = sizeof start, .dwFlags = STARTF_USESTDHANDLES, .hStdInput = input, .hStdOutput = output,
                        .hStdError = GetStdHandle(STD_ERROR_HANDLE)};
  PROCESS_INFORMATION program;
  if (words == NULL || !CreateProcessW(NULL, words, NULL, NULL, TRUE, 0, NULL, NULL, &start, &program)) return 66;
  CloseHandle(input);
  CloseHandle(output);
  CreateThread(NULL, 0, carry_input, NULL, 0, NULL);
  HANDLE rest = CreateThread(NULL, 0, carry_output, NULL, 0, NULL);
  WaitForSingleObject(program.hProcess, INFINITE);
  WaitForSingleObject(rest, INFINITE);
  DWORD code = 70;
  GetExitCodeProcess(program.hProcess, &code);
  ExitProcess(code);
}
