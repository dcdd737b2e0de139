#include "bench.h"
int accepted, foreign, wrong, result, actual[64], written[64];
static int sum_up(int first, int second) {
  int check = 0;
  for (int octet = 0; octet < 32; octet += 8) check = check + ((first >> octet) & 0xFF);
  for (int octet = 0; octet < 24; octet += 8) check = check ^ ((second >> octet) & 0xFF);
  return (check ^ (check >> 4)) & 0xF;
}
static void serve(int first, int second) {
  if ((first & 0xFF) != 0x68) { wrong++; return; }
  int address = (first >> 8) & 0x3;
  if (address == 3) { foreign++; return; }
  int service = (first >> 10) & 3;
  int index = (first >> 12) & 0x3F;
  int value = (first >> 18) & 0x3FF;
  if (value & 0x200) value = value | ~0x3FF;
  int ramp = second & 0xFFF;
  if ((sum_up(first, second) & 0x3) == ((second >> 24) & 0x3)) {
    accepted++;
    switch (service) {
      case 0: result = result * 3 + actual[index]; break;
      case 1: actual[index] = actual[index] + value; break;
      case 2: actual[index] = value ^ ramp; written[index] = written[index] + 1; break;
      case 3: if (second & 0x1000) actual[index] = 0; else written[index] = 0; break;
    }
  } else wrong++;
}
int main(void) {
  int noise = 71;
  for (int n = 0; n < 400000; n++) {
    noise = noise * 69069 + 5;
    int first = ((noise >> 4) << 8) | 0x68;
    if ((n & 31) == 0) first = first ^ 4;
    serve(first, noise ^ (n << 9));
  }
  for (int n = 0; n < 64; n++) result = result * 31 + actual[n] + written[n];
  PRINT(result ^ accepted ^ (foreign << 8) ^ (wrong << 16));
}
