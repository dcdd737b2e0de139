/* A bounded text: what an FMU says in one call beyond it is left out, but for the line that says why a call failed. Its threads
   may speak at once. */
#include "words.h"

#include <pthread.h>
#include <stdio.h>
#include <string.h>

#include "calls.h"
#include "protocol.h"

enum { LONGEST = 2000 };
static char words[1 << 16];
static size_t used;
static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;

static void put(char kind, size_t most, const char* format, va_list arguments) {
  char text[LONGEST];
  vsnprintf(text, sizeof text, format, arguments);
  pthread_mutex_lock(&mutex);
  for (char* line = text; *line != 0;) {
    const size_t length = strcspn(line, "\r\n");
    if (length != 0 && used + length + 2 <= most) {
      words[used++] = kind;
      memcpy(words + used, line, length);
      used += length;
      words[used++] = '\n';
    }
    line += length + (line[length] != 0);
  }
  pthread_mutex_unlock(&mutex);
}

void ipos_fmu_log(char kind, const char* format, va_list arguments) {
  put(kind, sizeof words - 2 * LONGEST, format, arguments);
}

void ipos_fmu_why(const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  put(IPOS_FMU_WARNS, sizeof words, format, arguments);
  va_end(arguments);
}

const char* ipos_fmu_words(size_t* length) {
  *length = used;
  return words;
}

void ipos_fmu_forget_words(void) { used = 0; }
