# The plant file: what it says as data, and its reader. It knows the names of what a plant has, and no plant.
find_package(tomlplusplus REQUIRED)
ipos_layer(plant_file
  FOLDERS runtime/plant_file
  SOURCES plant_file/toml_text.cpp plant_file/read_toml.cpp plant_file/toml_kind.cpp plant_file/bus_kind.cpp plant_file/state_names.cpp plant_file/signal.cpp
          plant_file/plant_file.cpp plant_file/plant_reader.cpp plant_file/read_bus.cpp plant_file/read_profibus.cpp plant_file/read_gateway.cpp
          plant_file/read_station.cpp plant_file/read_cards.cpp plant_file/read_motor.cpp plant_file/read_machine.cpp plant_file/read_foreign_machine.cpp plant_file/read_control.cpp plant_file/read_fms_master.cpp plant_file/read_canopen_master.cpp plant_file/read_fault.cpp plant_file/read_octet_fault.cpp plant_file/read_surroundings.cpp plant_file/read_expect.cpp plant_file/serial_plan.cpp plant_file/can_cable.cpp plant_file/line_disturbance.cpp plant_file/profibus_paper.cpp plant_file/line_alone.cpp plant_file/line_names.cpp plant_file/read_encoders.cpp
  USES unit bus drive motion storage stdlib
  LIBS fmt::fmt)
ipos_not_hot(ipos_plant_file SIZE 20)
