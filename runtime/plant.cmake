find_package(tomlplusplus REQUIRED)
ipos_layer(runtime
  FOLDERS runtime/services runtime/plant
  SOURCES services/variable_objects.cpp services/movilink_command.cpp services/drive_variables.cpp
          services/timers.cpp services/mirrored_values.cpp services/pid_block.cpp services/source_places.cpp
          services/communication_commands.cpp services/call_commands.cpp services/unit_commands.cpp
          services/system_values.cpp services/system_commands.cpp services/positioning_service.cpp
          services/positioning_commands.cpp
          plant/index_windows.cpp plant/wear.cpp plant/unit_memory.cpp plant/toml_text.cpp
          plant/signal.cpp plant/plant_file.cpp plant/plant_reader.cpp plant/read_bus.cpp plant/read_station.cpp
          plant/read_control.cpp plant/read_fault.cpp plant/read_surroundings.cpp plant/read_expect.cpp
          plant/serial_plan.cpp plant/drive_server.cpp plant/sbus_port.cpp plant/serial_port.cpp plant/station.cpp plant/station_power.cpp plant/station_steady.cpp
          plant/station_sleep.cpp plant/station_late.cpp plant/program_reach.cpp
          plant/signal_port.cpp plant/station_state.cpp plant/variable_names.cpp plant/surroundings.cpp plant/plant.cpp
  USES vm image bus scom drive positioning motion storage stdlib
  LIBS fmt::fmt)
