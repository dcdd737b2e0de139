/* The mock line: no arbitration, no errors; a frame takes less than the millisecond it is sent in. */
#include "can_mock.h"

enum { kPartnerObject = 1025, kPartnerCycle = 120 };

int can_mock_tick(struct can_registers* can, uint32_t tick) {
  int frames = 0;
  if (can->tx_request) {
    can->tx_request = 0;
    ++frames;
  }
  if (tick % kPartnerCycle == 1 && !can->rx_full) {
    /* H427 = 88776655h and H426 = 44332211h in MOTOROLA format: the high byte of the high variable first. */
    can->rx_id = kPartnerObject;
    can->rx_length = 8;
    can->rx_data[0] = 0x55667788;
    can->rx_data[1] = 0x11223344;
    can->rx_full = 1;
    ++frames;
  }
  return frames;
}
