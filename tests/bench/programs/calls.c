#include "bench.h"
int x = 300, y = 211, smallest = -20000, largest = 20000;
static __attribute__((noinline)) void limit(void) {
  if (x < smallest) x = smallest;
  if (x > largest) x = largest;
}
static __attribute__((noinline)) void scale(void) {
  x = x * y >> 8;
  limit();
}
static __attribute__((noinline)) void swap(void) {
  int z = x;
  x = y;
  y = z;
}
static __attribute__((noinline)) void turn(void) {
  swap();
  scale();
  swap();
  scale();
}
int main(void) {
  int result = 0;
  for (int i = 0; i < 2000000; i++) {
    turn();
    result = result + x - y;
    x = (i & 1023) + 200;
    y = (i & 511) + 100;
  }
  PRINT(result);
}
