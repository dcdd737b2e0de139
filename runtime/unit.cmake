# One unit and its plain millisecond: program, variables, drive, positioning, memory; and many of them at once.
ipos_layer(unit
  FOLDERS runtime/journal runtime/services runtime/nv_memory/kept runtime/commands runtime/unit
  SOURCES commands/movilink_command.cpp
          services/timers.cpp services/mirrored_values.cpp services/pid_block.cpp unit/program_image.cpp commands/source_places.cpp
          commands/communication_commands.cpp commands/call_commands.cpp commands/unit_commands.cpp
          commands/system_values.cpp commands/system_commands.cpp services/positioning_service.cpp
          commands/positioning_commands.cpp
          nv_memory/kept/index_windows.cpp nv_memory/kept/wear.cpp nv_memory/kept/unit_memory.cpp unit/drive_server.cpp
          unit/unit.cpp unit/unit_reports.cpp unit/unit_power.cpp unit/program_reach.cpp unit/many_ticks.cpp
  USES vm image bus scom drive positioning motion storage stdlib pace
  LIBS fmt::fmt)
ipos_batches(ipos_unit SIZE 20
             HOT unit/unit.cpp services/timers.cpp services/mirrored_values.cpp services/positioning_service.cpp unit/program_reach.cpp
                 unit/many_ticks.cpp)
