#include "bench.h"
int main(void) {
  int result = 0, state = 0, count = 0;
  for (int i = 0; i < 20000000; i++) {
    switch (state) {
      case 0: state = 1; break;
      case 1: count++; state = 2; break;
      case 2: if (count & 1) state = 4; else state = 3; break;
      case 3: result += count; state = 5; break;
      case 4: result -= 3; state = 6; break;
      case 5: state = 7; break;
      case 6: result ^= count; state = 7; break;
      case 7: state = 0; break;
    }
  }
  PRINT(result);
}
