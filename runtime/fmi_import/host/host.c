/* The process of an FMU: its library is loaded here, so that what it does wrong ends this process and not ipos. Standard C and
   POSIX only, and linked against nothing but the C library, whose loader the FMU needs anyway.
   ipos_fmu_host SOCKET FOLDER: orders come over the file of this number; at their end the folder is removed. */
#define _GNU_SOURCE
#include <errno.h>
#include <ftw.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "calls.h"
#include "protocol.h"

static int line;
static int leaves;  /* it is this program that ends */

static int write_all(const void* data, size_t size) {
  const char* at = data;
  while (size != 0) {
    const ssize_t done = write(line, at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return 0;
    at += done;
    size -= (size_t)done;
  }
  return 1;
}

static int read_all(void* data, size_t size) {
  char* at = data;
  while (size != 0) {
    const ssize_t done = read(line, at, size);
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return 0;
    at += done;
    size -= (size_t)done;
  }
  return 1;
}

static int remove_one(const char* path, const struct stat* what, int kind, struct FTW* place) {
  (void)what;
  (void)kind;
  (void)place;
  remove(path);  /* what cannot be removed stays, the rest goes */
  return 0;
}

static void leave(int code) {
  leaves = 1;
  _exit(code);
}

/* The last words. write() may be called here. */
static void on_signal(int number) {
  const struct ipos_fmu_head head = {IPOS_FMU_SIGNAL, (uint32_t)number, 0, 0};
  write_all(&head, sizeof head);
  _exit(1);
}

static void on_exit_called(void) {
  if (leaves) return;
  const struct ipos_fmu_head head = {IPOS_FMU_EXIT, 0, 0, 0};
  write_all(&head, sizeof head);
  _exit(1);
}

static void watch_signals(void) {
  static char stack[1 << 16];
  const stack_t other = {.ss_sp = stack, .ss_size = sizeof stack};
  sigaltstack(&other, NULL);
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_signal;
  action.sa_flags = SA_ONSTACK | (int)SA_RESETHAND;
  const int numbers[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP};
  for (size_t n = 0; n < sizeof numbers / sizeof *numbers; ++n) sigaction(numbers[n], &action, NULL);
  signal(SIGPIPE, SIG_IGN);
}

static int answer(enum ipos_fmu_outcome outcome, const void* values, size_t size) {
  fflush(NULL);
  size_t length = 0;
  const char* words = ipos_fmu_words(&length);
  const struct ipos_fmu_head head = {outcome, 0, size, length};
  const int sent = write_all(&head, sizeof head) && write_all(values, size) && write_all(words, length);
  ipos_fmu_forget_words();
  return sent;
}

int main(int argc, char** argv) {
  if (argc != 3) return 64;
  line = atoi(argv[1]);
  atexit(on_exit_called);
  watch_signals();
  const uint32_t pid = (uint32_t)getpid();
  if (!write_all(&pid, sizeof pid)) leave(1);
  struct ipos_fmu_head head;
  while (read_all(&head, sizeof head)) {
    char* bytes = malloc(head.bytes + 1);
    if (bytes == NULL || !read_all(bytes, head.bytes)) break;
    /* Who asks gives up after that time; this is for the case that nobody is left to do so. */
    alarm(2 * ipos_fmu_seconds() + 60);
    const void* values = NULL;
    size_t size = 0;
    const int good = ipos_fmu_call(head.what, bytes, head.bytes, &values, &size);
    alarm(0);
    free(bytes);
    if (!answer(good ? IPOS_FMU_GOOD : IPOS_FMU_FAILED, good ? values : NULL, good ? size : 0)) break;
  }
  if (chdir("/") == 0) nftw(argv[2], remove_one, 16, FTW_DEPTH | FTW_PHYS);
  alarm(10);
  ipos_fmu_end();
  leave(0);
}
