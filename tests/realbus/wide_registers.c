// Lets user-mode-linux boot on a processor with AMX (Debian 12's: 6.1), preloaded by boot.sh. It sets a process's
// floating-point registers from a buffer of the size it was built with, but the kernel below takes the whole state or
// nothing. So what the buffer does not have keeps its present content.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <elf.h>
#include <stdarg.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/uio.h>

#define WIDEST_STATE (64 * 1024)  // bytes; with AMX it has 11 008

typedef long (*Ptrace)(int request, int pid, void* address, void* data);

long ptrace(enum __ptrace_request request, ...) {
  static Ptrace next;
  if (!next) next = (Ptrace)dlsym(RTLD_NEXT, "ptrace");

  va_list arguments;
  va_start(arguments, request);
  const int pid = va_arg(arguments, int);
  void* address = va_arg(arguments, void*);
  void* data = va_arg(arguments, void*);
  va_end(arguments);

  if (request != PTRACE_SETREGSET || (long)address != NT_X86_XSTATE) return next(request, pid, address, data);

  static char state[WIDEST_STATE];
  struct iovec whole = {state, sizeof state};
  const long read = next(PTRACE_GETREGSET, pid, address, &whole);
  if (read != 0) return read;
  const struct iovec* part = data;
  memcpy(state, part->iov_base, part->iov_len < whole.iov_len ? part->iov_len : whole.iov_len);
  return next(PTRACE_SETREGSET, pid, address, &whole);
}
