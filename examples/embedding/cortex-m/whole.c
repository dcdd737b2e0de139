/* Refers to every function of ipos.h, so that a program with this file contains the whole library. */
#include <ipos.h>

#include "board.h"

typedef void (*function)(void);
#define KEEP(name) (function)(name)
static const function functions[] = {
    KEEP(ipos_version),
    KEEP(ipos_features),
    KEEP(ipos_most_variables),
    KEEP(ipos_most_words),
    KEEP(ipos_status_text),
    KEEP(ipos_program_size),
    KEEP(ipos_program_load),
    KEEP(ipos_rule_text),
    KEEP(ipos_program_info_of),
    KEEP(ipos_accelerate_size),
    KEEP(ipos_program_accelerate),
    KEEP(ipos_symbol_at),
    KEEP(ipos_find),
    KEEP(ipos_vm_size),
    KEEP(ipos_init),
    KEEP(ipos_program_of),
    KEEP(ipos_start),
    KEEP(ipos_stop),
    KEEP(ipos_set_rates),
    KEEP(ipos_set_sbus),
    KEEP(ipos_run_ticks),
    KEEP(ipos_run_commands),
    KEEP(ipos_run_due),
    KEEP(ipos_ticks),
    KEEP(ipos_read),
    KEEP(ipos_write),
    KEEP(ipos_read_symbol),
    KEEP(ipos_write_symbol),
    KEEP(ipos_variables),
    KEEP(ipos_task_of),
    KEEP(ipos_start_task),
    KEEP(ipos_stop_task),
    KEEP(ipos_resume),
    KEEP(ipos_raise_event),
    KEEP(ipos_fault_of),
    KEEP(ipos_raise_fault),
    KEEP(ipos_receive),
    KEEP(ipos_sent),
    KEEP(ipos_nv_store),
    KEEP(ipos_nv_load),
    KEEP(ipos_state_size),
    KEEP(ipos_save),
    KEEP(ipos_restore),
};

int scom_main(void) {
  static volatile unsigned which;
  functions[which]();
  return 0;
}
