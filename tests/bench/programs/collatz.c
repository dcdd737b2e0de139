#include "bench.h"
int main(void) {
  int result = 0, longest = 0;
  for (int i = 1; i < 300000; i++) {
    int n = i, length = 1;
    while (n != 1) {
      if (n & 1) {
        if (n > 715827882) break;
        n = n * 3 + 1;
      } else {
        n = n >> 1;
      }
      length++;
    }
    if (length > longest) {
      longest = length;
      result = i;
    }
  }
  PRINT(result);
}
