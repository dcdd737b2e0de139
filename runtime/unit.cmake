# One unit and its plain millisecond: program, variables, drive, positioning, memory; and many of them at once.
ipos_layer(unit
  FOLDERS runtime/services runtime/unit
  SOURCES services/variable_objects.cpp services/movilink_command.cpp services/drive_variables.cpp
          services/timers.cpp services/mirrored_values.cpp services/pid_block.cpp services/source_places.cpp
          services/communication_commands.cpp services/call_commands.cpp services/unit_commands.cpp
          services/system_values.cpp services/system_commands.cpp services/positioning_service.cpp
          services/positioning_commands.cpp
          unit/index_windows.cpp unit/wear.cpp unit/unit_memory.cpp unit/drive_server.cpp
          unit/unit.cpp unit/unit_reports.cpp unit/unit_power.cpp unit/program_reach.cpp unit/many_ticks.cpp
  USES vm image bus scom drive positioning motion storage stdlib pace
  LIBS fmt::fmt)
