# One unit and its plain millisecond: program, variables, drive, positioning, memory; and many of them at once. Below it
# what it is made of: what it tells, what serves its program beside the drive, what it keeps, the commands.
ipos_layer(journal FOLDERS runtime/journal USES clock)
ipos_layer(services FOLDERS runtime/services
  SOURCES services/timers.cpp services/mirrored_values.cpp services/pid_block.cpp services/positioning_service.cpp services/lead.cpp services/synchronous_service.cpp
  USES journal drive positioning part stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_services HOT services/timers.cpp services/mirrored_values.cpp services/positioning_service.cpp services/lead.cpp)
ipos_layer(kept FOLDERS runtime/nv_memory/kept
  SOURCES nv_memory/kept/index_windows.cpp nv_memory/kept/wear.cpp nv_memory/kept/unit_memory.cpp
  USES journal storage drive exec image isa stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_kept)
ipos_layer(commands FOLDERS runtime/commands
  SOURCES commands/movilink_command.cpp commands/source_places.cpp commands/communication_commands.cpp
          commands/call_commands.cpp commands/unit_commands.cpp commands/system_values.cpp commands/system_commands.cpp
          commands/positioning_commands.cpp
  USES journal services kept bus_movilink scom drive exec image isa stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_commands SIZE 20)
ipos_layer(unit FOLDERS runtime/unit
  SOURCES unit/program_image.cpp unit/unit_interface.cpp unit/unit.cpp unit/unit_reports.cpp unit/unit_power.cpp unit/unit_program.cpp
          unit/program_reach.cpp unit/moving_ticks.cpp unit/many_ticks.cpp
  USES journal services kept commands bus_movilink scom drive vm image pace stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_unit SIZE 20 HOT unit/unit.cpp unit/program_reach.cpp unit/moving_ticks.cpp unit/many_ticks.cpp)
