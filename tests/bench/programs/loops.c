#include "bench.h"
int main(void) {
  int s = 0;
  for (int i = 0; i < 300; i++)
    for (int j = 0; j < 300; j++)
      for (int k = 0; k < 300; k++) s = (s + i * j - k) ^ (k << 1);
  PRINT(s);
}
