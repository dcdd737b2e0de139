/* The board MPS2 (QEMU: mps2-an385 for Cortex-M3, mps2-an386 for Cortex-M4): vectors, start, and text by
 * semihosting. No heap, no library start-up. */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "board.h"

struct can_registers* const board_can = (struct can_registers*)0x20100000;

enum { kWrite0 = 0x04, kExitExtended = 0x20, kApplicationExit = 0x20026, kRuntimeError = 0x20023 };

static int semihost(int operation, const void* argument) {
  register int r0 __asm__("r0") = operation;
  register const void* r1 __asm__("r1") = argument;
  __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
  return r0;
}

void board_print(const char* text) { semihost(kWrite0, text); }

static void leave(uint32_t reason, uint32_t code) {
  const uint32_t block[2] = {reason, code};
  for (;;) semihost(kExitExtended, block);
}

extern uint32_t data_begin[], data_end[], data_load[], bss_begin[], bss_end[], stack_top[];

__attribute__((noreturn)) void reset(void) {
  memcpy(data_begin, data_load, (size_t)((char*)data_end - (char*)data_begin));
  memset(bss_begin, 0, (size_t)((char*)bss_end - (char*)bss_begin));
#ifdef __ARM_FP
  *(volatile uint32_t*)0xE000ED88 |= 0xFu << 20; /* CPACR: the FPU is on */
  __asm__ volatile("dsb\n isb");
#endif
  memset(board_can, 0, sizeof *board_can);
  leave(kApplicationExit, (uint32_t)scom_main());
  for (;;) {
  }
}

static void trap(void) {
  board_print("processor exception\n");
  leave(kRuntimeError, 70);
}

__attribute__((section(".vectors"), used)) static void (*const vectors[16])(void) = {
    (void (*)(void))stack_top, reset, trap, trap, trap, trap, trap, 0, 0, 0, 0, trap, trap, 0, trap, trap};
