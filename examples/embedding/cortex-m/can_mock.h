/* The other end of the mock CAN controller: a line with one more station on it, the partner of SCOM1. */
#ifndef CAN_MOCK_H
#define CAN_MOCK_H

#include <stdint.h>

#include "board.h"

/* One millisecond of the line: sends what is asked for, and lets the partner send its object, 1025 every 120
 * ms (examples/scom/SCOM2.IPC). Returns how many frames have gone over the line. */
int can_mock_tick(struct can_registers* can, uint32_t tick);

#endif
