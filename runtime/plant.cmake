find_package(tomlplusplus REQUIRED)
ipos_layer(runtime
  FOLDERS runtime/services runtime/plant
  SOURCES services/variable_objects.cpp services/movilink_command.cpp services/system_commands.cpp
          plant/plant_file.cpp plant/drive_server.cpp plant/sbus_port.cpp plant/station.cpp plant/plant.cpp
  USES vm image bus drive stdlib
  LIBS fmt::fmt)
