/* What an FMU and its calls have to say, until the next answer. */
#ifndef IPOS_FMU_WORDS_H
#define IPOS_FMU_WORDS_H

#include <stdarg.h>

void ipos_fmu_log(char kind, const char* format, va_list arguments);
/* Why a call failed, in one line. */
void ipos_fmu_why(const char* format, ...) __attribute__((format(printf, 1, 2)));

#endif
