#include "bench.h"
int columns[8], rising[16], falling[16], place[9];
int main(void) {
  int result = 0;
  for (int round = 0; round < 60; round++) {
    int row = 0;
    place[0] = -1;
    while (row >= 0) {
      int column = place[row];
      if (column >= 0) {
        columns[column] = 0;
        rising[row + column] = 0;
        falling[row - column + 7] = 0;
      }
      int free_place = 0;
      for (column++; column < 8 && !free_place; column++)
        free_place = !(columns[column] | rising[row + column] | falling[row - column + 7]);
      if (!free_place) {
        row--;
        continue;
      }
      column--;
      place[row] = column;
      columns[column] = 1;
      rising[row + column] = 1;
      falling[row - column + 7] = 1;
      if (row == 7) {
        result++;
      } else {
        row++;
        place[row] = -1;
      }
    }
  }
  PRINT(result);
}
