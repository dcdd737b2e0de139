/* The calls of an FMU behind the orders of ipos, and what it says to its logger. */
#ifndef IPOS_FMU_CALLS_H
#define IPOS_FMU_CALLS_H

#include <stddef.h>
#include <stdint.h>

/* False: the last of the words says why. The values stay until the next call. */
int ipos_fmu_call(uint32_t order, const char* bytes, size_t size, const void** values, size_t* values_size);
void ipos_fmu_end(void);
unsigned ipos_fmu_seconds(void);

/* Lines, each with IPOS_FMU_WARNS or IPOS_FMU_TELLS in front. */
const char* ipos_fmu_words(size_t* length);
void ipos_fmu_forget_words(void);

#endif
