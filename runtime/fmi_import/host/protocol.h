/* What ipos and the process of an FMU say to each other, over a socket. Both are of one build, so numbers stand as they do in
   memory. A request is a head and its bytes, an answer likewise; there is one answer a request, in turn. C, for the host. */
#ifndef IPOS_FMU_PROTOCOL_H
#define IPOS_FMU_PROTOCOL_H

#include <stdint.h>

enum ipos_fmu_order {
  IPOS_FMU_BEGIN = 1,  /* ipos_fmu_begin, variables, then texts; the library is loaded and instantiated */
  IPOS_FMU_START,      /* inputs; parameters and inputs are set, initialization passes; outputs */
  IPOS_FMU_STEP,       /* time, length, inputs; outputs */
  IPOS_FMU_SAVE,       /* bytes of the state */
  IPOS_FMU_RESTORE     /* with them */
};

enum ipos_fmu_outcome {
  IPOS_FMU_GOOD = 0,   /* values, then words: lines of the FMU's log */
  IPOS_FMU_FAILED,     /* words: the last line says why */
  IPOS_FMU_SIGNAL,     /* number: of the signal that ended it */
  IPOS_FMU_EXIT        /* it has called exit() */
};

struct ipos_fmu_head {
  uint32_t what;   /* order or outcome */
  uint32_t number;
  uint64_t bytes;  /* of values or of the request's own */
  uint64_t words;  /* bytes of text behind them */
};

/* A line of the log begins with one of these. */
#define IPOS_FMU_WARNS '!'
#define IPOS_FMU_TELLS ' '

/* As the model description names the types. Enumerations are Int32 in FMI 2 and Int64 in FMI 3. */
enum ipos_fmu_type {
  IPOS_FMU_FLOAT64, IPOS_FMU_FLOAT32, IPOS_FMU_INT8, IPOS_FMU_UINT8, IPOS_FMU_INT16, IPOS_FMU_UINT16, IPOS_FMU_INT32,
  IPOS_FMU_UINT32, IPOS_FMU_INT64, IPOS_FMU_UINT64, IPOS_FMU_BOOLEAN
};

struct ipos_fmu_variable {
  uint32_t reference;
  uint32_t type;
  double value;  /* of a parameter */
};

/* Behind it: parameters, inputs, outputs, and four texts that end with 0: library, name, token, resources. */
struct ipos_fmu_begin {
  uint32_t version;  /* 2 or 3 */
  uint32_t parameters;
  uint32_t inputs;
  uint32_t outputs;
  uint32_t seconds;  /* on the clock that an answer may take */
};

#endif
