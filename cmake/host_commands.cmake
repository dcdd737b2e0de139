# ipos_commands.h of the library: the commands of the instruction set that the host carries out. It is written out of
# vm/isa/opcodes.def, so that a new command is a row there and nothing here.
set(opcodes ${PROJECT_SOURCE_DIR}/vm/isa/opcodes.def)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${opcodes})
file(STRINGS ${opcodes} rows REGEX "^OPCODE.* Host, ")
set(lines "")
foreach(row IN LISTS rows)
  if(NOT row MATCHES "^OPCODE\\((0x..), ([A-Za-z0-9]+), *\"([^\"]*)\", .* Host, *\"([^\"]*)\"\\)$")
    message(FATAL_ERROR "${opcodes}: cmake/host_commands.cmake cannot read this row:\n${row}")
  endif()
  string(APPEND lines " \\\n  X(${CMAKE_MATCH_2}, ${CMAKE_MATCH_1}) /* ${CMAKE_MATCH_3}: ${CMAKE_MATCH_4} */")
endforeach()
set(ipos_written_headers ${PROJECT_BINARY_DIR}/include)
file(CONFIGURE OUTPUT ${ipos_written_headers}/ipos_commands.h @ONLY CONTENT
"/* The commands that reach the `command` callback of ipos.h: X(name, code), and how the assembler writes them, which
 * gives the operands in order (docs/reference/isa.md). The build has written this file. */
#ifndef IPOS_COMMANDS_H
#define IPOS_COMMANDS_H

#define IPOS_HOST_COMMANDS(X)@lines@

#endif
")
