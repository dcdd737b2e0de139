/* What the sample needs of the board it runs on: a place for text and a CAN controller in memory. */
#ifndef BOARD_H
#define BOARD_H

#include <stdint.h>

/* Registers of the mock CAN controller: one mailbox to send, one to receive. */
struct can_registers {
  volatile uint32_t tx_request; /* 1 asks for sending; the controller makes it 0 */
  volatile uint32_t tx_id;
  volatile uint32_t tx_length;
  volatile uint32_t tx_data[2]; /* byte 0 in bits 0..7 of word 0 */
  volatile uint32_t rx_full;    /* the controller makes it 1, who has read the frame 0 */
  volatile uint32_t rx_id;
  volatile uint32_t rx_length;
  volatile uint32_t rx_data[2];
};

extern struct can_registers* const board_can;
void board_print(const char* text);

int scom_main(void); /* 0: as the manual prints it */

#endif
