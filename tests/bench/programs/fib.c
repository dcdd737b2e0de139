#include "bench.h"
static __attribute__((noinline)) int fib(int n) { return n < 2 ? n : fib(n - 1) + fib(n - 2); }
int main(void) {
  volatile int depth = 30;
  int result = 0;
  for (int round = 0; round < 10; round++) result = fib(depth);
  PRINT(result);
}
