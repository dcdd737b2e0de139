/* What the C forms of the benchmarks share: 32-bit numbers that wrap (compile with -fwrapv). */
#include <stdint.h>
#include <stdio.h>
#define PRINT(value) printf("%d\n", (int)(value))
/* Keeps the compiler from dropping rounds whose results are overwritten. */
#define CLOBBER(array) __asm__ volatile("" : : "r"(array) : "memory")
