/* The board on a host: text goes to stdout, the CAN registers are ordinary memory. */
#include <stdio.h>

#include "board.h"

static struct can_registers registers;
struct can_registers* const board_can = &registers;

void board_print(const char* text) { fputs(text, stdout); }

int main(void) { return scom_main(); }
