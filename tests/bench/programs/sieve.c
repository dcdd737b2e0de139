#include "bench.h"
int h[1024];
int main(void) {
  int result = 0;
  for (int round = 0; round < 20000; round++) {
    result = 0;
    for (int i = 0; i < 900; i++) h[i] = 1;
    for (int i = 2; i < 900; i++) {
      if (h[i]) {
        for (int k = i + i; k < 900; k += i) h[k] = 0;
        result++;
      }
    }
    CLOBBER(h);
  }
  PRINT(result);
}
