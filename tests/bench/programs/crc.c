#include "bench.h"
int main(void) {
  uint32_t c = 0xFFFFFFFFu, x = 1;
  for (int i = 0; i < 1048576; i++) {
    x = x * 69069u + 1u;
    c ^= (x >> 16) & 255u;
    for (int k = 0; k < 8; k++) c = (c >> 1) ^ (0xEDB88320u & -(c & 1u));
  }
  PRINT((int)~c);
}
