#include "bench.h"
int main(void) {
  int result = 0, word = 12345;
  for (int i = 0; i < 500000; i++) {
    word = word * 1103 + 12345;
    int reversed = 0, ones = 0;
    for (int k = 0; k < 16; k++) {
      reversed <<= 1;
      if (word & (1 << k)) {
        reversed |= 1;
        ones++;
      }
    }
    int packed = 0, digits = word & 0x7FFF;
    for (int k = 0; k < 4; k++) {
      packed = (packed << 4) | digits % 10;
      digits = digits / 10;
    }
    result = (result ^ reversed) + (packed ^ ones);
  }
  PRINT(result);
}
