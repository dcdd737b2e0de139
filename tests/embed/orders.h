/* What happens to a machine in a comparison, out of a seed: answers of the host and orders between ticks. C99 and C++, as the
 * file for firmware is run with it on other processors, and the interpreter of the simulation beside it. */
#ifndef IPOS_TESTS_ORDERS_H
#define IPOS_TESTS_ORDERS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct chance {
  uint32_t state;
} chance;

static inline uint32_t chance_next(chance* of) { /* Marsaglia's xorshift32; never 0 */
  of->state ^= of->state << 13;
  of->state ^= of->state >> 17;
  of->state ^= of->state << 5;
  return of->state;
}
static inline uint32_t chance_below(chance* of, uint32_t limit) { return (chance_next(of) >> 8) % limit; }

/* The numbers are those of ipos_answer. */
typedef struct host_answer {
  int32_t answer;
  uint8_t fault;
  bool writes;
  uint32_t variable;
  int32_t value;
} host_answer;

/* `can_call`: the command has a label that the host may have called. */
static inline host_answer answer_of(chance* of, bool can_call, uint32_t variables) {
  host_answer out = {0, 0, false, 0, 0};
  const uint32_t kind = chance_below(of, 64);
  if (kind < 10) out.answer = 2;
  if (kind >= 10 && kind < 30 && can_call) out.answer = 1;
  if (kind == 63) {
    out.answer = 3;
    out.fault = (uint8_t)(1 + chance_below(of, 255));
  }
  out.writes = chance_below(of, 4) == 0;
  out.variable = chance_below(of, variables);
  out.value = (int32_t)chance_next(of);
  return out;
}

typedef enum order_kind { ORDER_NONE, ORDER_WRITE, ORDER_EVENT, ORDER_RESUME, ORDER_START, ORDER_STOP, ORDER_FAULT } order_kind;

typedef struct order {
  order_kind kind;
  uint32_t number; /* variable, event 0..2, context 1..10, task */
  int32_t value;
} order;

static inline order order_of(chance* of, uint32_t variables, uint32_t tasks) {
  order out = {ORDER_NONE, 0, 0};
  const uint32_t kind = chance_below(of, 32);
  if (kind < 6) {
    out.kind = ORDER_WRITE;
    out.number = kind < 4 ? chance_below(of, 16) * 8 : chance_below(of, variables);
    out.value = kind % 2 == 0 ? (int32_t)chance_next(of) : (int32_t)chance_below(of, 16) - 4;
  } else if (kind < 10) {
    out.kind = ORDER_EVENT;
    out.number = chance_below(of, 3);
  } else if (kind < 20) {
    out.kind = ORDER_RESUME;
    out.number = 1 + chance_below(of, 10);
  } else if (kind == 20) {
    out.kind = ORDER_START;
    out.number = 1 + chance_below(of, tasks);
  } else if (kind == 21) {
    out.kind = ORDER_STOP;
    out.number = 1 + chance_below(of, tasks);
  } else if (kind == 22 && chance_below(of, 8) == 0) {
    out.kind = ORDER_FAULT;
    out.number = 1 + chance_below(of, 255);
  }
  return out;
}

/* FNV-1a, of bytes. */
static inline uint32_t hash_of(uint32_t hash, const uint8_t* bytes, uint32_t size) {
  for (; size != 0; --size) hash = (hash ^ *bytes++) * 16777619U;
  return hash;
}

enum { ORDERS_HASH_EVERY = 5 }; /* ticks; and after the last */

#endif
