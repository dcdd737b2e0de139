find_package(tomlplusplus REQUIRED)
ipos_layer(runtime
  FOLDERS runtime/services runtime/plant
  SOURCES services/variable_objects.cpp services/movilink_command.cpp services/system_commands.cpp services/drive_variables.cpp
          plant/plant_file.cpp plant/serial_plan.cpp plant/drive_server.cpp plant/serial_port.cpp plant/station.cpp plant/plant.cpp
  USES vm image bus drive motion stdlib
  LIBS fmt::fmt)
