/* Prints sizes and offsets of the structures of ipos.h and ipos_compile.h. */
#include <ipos.h>
#include <ipos_compile.h>
#include <stdio.h>

#define SIZE(type) printf(#type " %zu\n", sizeof(type));
#define AT(type, member) printf(#type "." #member " %zu\n", offsetof(type, member));

int main(void) {
  SIZE(ipos_status)
  SIZE(ipos_trouble)
  AT(ipos_trouble, offset) AT(ipos_trouble, word) AT(ipos_trouble, rule) AT(ipos_trouble, violations)
      SIZE(ipos_program_info) AT(ipos_program_info, unit) AT(ipos_program_info, variables)
          AT(ipos_program_info, words) AT(ipos_program_info, symbols) AT(ipos_program_info, checksum)
              SIZE(ipos_symbol) AT(ipos_symbol, length) AT(ipos_symbol, variable) AT(ipos_symbol, count) SIZE(
                  ipos_command) AT(ipos_command, context) AT(ipos_command, address) AT(ipos_command, operands)
                  SIZE(ipos_reply) AT(ipos_reply, fault) AT(ipos_reply, reason) SIZE(ipos_frame)
                      AT(ipos_frame, length) AT(ipos_frame, data) SIZE(ipos_fault) AT(ipos_fault, task) AT(
                          ipos_fault, context) AT(ipos_fault, address) AT(ipos_fault, reason) SIZE(ipos_step)
                          AT(ipos_step, address) AT(ipos_step, word) AT(ipos_step, context) SIZE(ipos_host)
                              AT(ipos_host, command) AT(ipos_host, cancel) AT(ipos_host, send)
                                  AT(ipos_host, time_us) AT(ipos_host, nv_write) AT(ipos_host, nv_read)
                                      AT(ipos_host, fault) AT(ipos_host, trace) SIZE(ipos_progress) AT(
                                          ipos_progress, commands) SIZE(ipos_task) AT(ipos_task, address)
                                          AT(ipos_task, wait_ms) AT(ipos_task, depth) AT(ipos_task, commands)
                                              SIZE(ipos_compile_job) AT(ipos_compile_job, source)
                                                  AT(ipos_compile_job, unit) AT(ipos_compile_job, read_file)
                                                      AT(ipos_compile_job, image)
                                                          AT(ipos_compile_job, image_size)
                                                              AT(ipos_compile_job, messages_size) return 0;
}
