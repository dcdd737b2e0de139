#include "bench.h"
int main(void) {
  static int v[100];
  int result = 0, seed = 7;
  for (int round = 0; round < 1500; round++) {
    for (int i = 0; i < 100; i++) {
      seed = (seed * 1103 + 12345) & 0xFFFF;
      v[i] = seed;
    }
    for (int i = 1; i < 100; i++) {
      int x = v[i], j = i - 1;
      while (j >= 0 && v[j] > x) {
        v[j + 1] = v[j];
        j--;
      }
      v[j + 1] = x;
    }
    result = result + v[50] - v[10];
  }
  PRINT(result);
}
