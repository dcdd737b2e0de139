#include "bench.h"
#define BIT_SET(word, bit) ((word) |= 1 << (bit))
#define BIT_CLEAR(word, bit) ((word) &= ~(1 << (bit)))
#define BIT_MOVE(word, bit, from, of) ((word) = ((word) & ~(1 << (bit))) | ((((from) >> (of)) & 1) << (bit)))
int main(void) {
  int result = 0, step = 0, outputs = 0, settle = 0, limit = 0, done = 0, rejected = 0, noise = 1913, last = 0;
  for (int cycle = 0; cycle < 3000000; cycle++) {
    if (settle > 0) settle--;
    if (limit > 0) limit--;
    noise = (noise * 1229 + 351) & 0xFFFF;
    int inputs = noise >> 7;
    switch (step) {
      case 0: if (inputs & 2) { BIT_SET(outputs, 1); settle = 6; limit = 30; step = 1; } break;
      case 1: if (settle == 0 && (inputs & 1)) { BIT_CLEAR(outputs, 1); BIT_SET(outputs, 4); limit = 11; step = 2; } break;
      case 2: if ((inputs & 0x30) == 0x30) { settle = 5; step = 3; } else if (limit == 0) step = 6; break;
      case 3: BIT_MOVE(outputs, 6, inputs, 3); if (settle == 0) step = 4; break;
      case 4: done++; last = outputs; settle = 3; step = 5; break;
      case 5: BIT_MOVE(outputs, 2, ~inputs, 0); if (settle == 0) { outputs = outputs & ~0x50; step = 0; } break;
      case 6: rejected++; BIT_SET(outputs, 7); settle = 18; step = 7; break;
      case 7: if (settle == 0 && (inputs & 4)) { BIT_CLEAR(outputs, 7); step = 0; } break;
    }
    result = result * 3 + outputs + step;
  }
  PRINT(result ^ done ^ (rejected << 16) ^ last);
}
