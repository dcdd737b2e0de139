#include "bench.h"
int px[33], py[33];
static int interpolate(int at) {
  int low = 0, high = 32;
  while (high - low > 1) {
    int middle = (low + high) >> 1;
    if (px[middle] <= at) low = middle;
    else high = middle;
  }
  return py[low] + (py[low + 1] - py[low]) * (at - px[low]) / (px[low + 1] - px[low]);
}
int main(void) {
  int result = 0;
  for (int i = 0; i < 33; i++) {
    px[i] = i * i * 3 + i;
    py[i] = (i * 7919) & 4095;
  }
  for (int i = 0; i < 1000000; i++) result = result * 3 + interpolate((i * 77) & 2047);
  PRINT(result);
}
