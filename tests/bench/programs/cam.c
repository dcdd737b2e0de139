#include "bench.h"
#define POINTS 16
#define RECORD 2
int points[128];
static int follow(int disk, int angle) {
  const int* point = points + disk * POINTS * RECORD;
  const int* end = point + (POINTS - 2) * RECORD;
  while (point[2] <= angle) {
    point = point + RECORD;
    if (point >= end) break;
  }
  int width = point[2] - point[0];
  return point[1] + (point[3] - point[1]) * (angle - point[0]) / width;
}
int main(void) {
  int result = 0;
  int* point = points;
  for (int disk = 0; disk < 4; disk++) {
    for (int k = 0; k < POINTS; k++) {
      point[0] = k * (38 + disk * 2) + (k & 3) * disk;
      point[1] = (k * 5851 + disk * 977) & 2047;
      point = point + RECORD;
    }
  }
  for (int turn = 0; turn < 600000; turn++) result = result * 5 + follow(turn & 3, (turn * 29) & 511);
  PRINT(result);
}
