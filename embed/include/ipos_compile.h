/* ipos_compile.h - the ipos compiler as a library for hosts, in C99.
 *
 * Makes an image for ipos.h of source text. Unlike ipos.h it uses the heap while it works; nothing of it remains
 * when a call returns. No global state: any number of threads may compile at once. Nothing throws or aborts.
 */
#ifndef IPOS_COMPILE_H
#define IPOS_COMPILE_H

#include "ipos.h"

#ifdef __cplusplus
extern "C" {
#endif
#ifdef __GNUC__
#pragma GCC visibility push(default)
#endif

/* Takes `size` bytes of a file; may be called several times. `sink` is that of ipos_read_file. */
typedef void (*ipos_add_bytes)(void* sink, const char* bytes, size_t size);

/* Reads the file `path` (terminated by 0) for #include and hands its bytes to `add`. False: there is none. */
typedef bool (*ipos_read_file)(void* user, const char* path, ipos_add_bytes add, void* sink);

/* One compilation. Start with all members 0 and set what is needed. */
typedef struct ipos_compile_job {
  /* What to compile. The strings are terminated by 0 unless a length is given. */
  const char* name;                /* of the file, for messages */
  const char* source;              /* its text */
  size_t source_size;              /* bytes of the text; 0: up to its terminating 0 */
  const char* unit;                /* unit type, "mdxb"; null: as the included headers say */
  const char* const* defines;      /* "NAME" or "NAME=TEXT"; may be null */
  size_t define_count;
  const char* const* include_dirs; /* where #include looks, in order; may be null */
  size_t include_dir_count;
  ipos_read_file read_file;        /* null: only the headers the library contains exist */
  void* user;                      /* for read_file */

  /* Where the image goes: memory of the caller. Too small: IPOS_MEMORY_TOO_SMALL, nothing is written. */
  void* image;                     /* may be null with image_capacity 0; aligned to 4 it can be loaded in place */
  size_t image_capacity;
  size_t image_size;               /* set: bytes of the image, also when it did not fit; 0 with errors */

  /* Where errors and warnings go as text, cut if they are too long, terminated by 0. */
  char* messages;                  /* may be null with messages_capacity 0 */
  size_t messages_capacity;
  size_t messages_size;            /* set: bytes of all messages without the terminating 0 */
} ipos_compile_job;

/* Compiles. IPOS_OK (there may be warnings among the messages), IPOS_SOURCE_ERROR, IPOS_MEMORY_TOO_SMALL,
 * IPOS_UNKNOWN_UNIT, IPOS_INVALID_ARGUMENT, IPOS_OUT_OF_MEMORY. */
ipos_status ipos_compile(ipos_compile_job* job);

#ifdef __GNUC__
#pragma GCC visibility pop
#endif
#ifdef __cplusplus
}
#endif

#endif /* IPOS_COMPILE_H */
