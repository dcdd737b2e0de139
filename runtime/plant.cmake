find_package(tomlplusplus REQUIRED)
# A plant: stations, which are units on lines, their surroundings, and the file that describes it.
ipos_layer(runtime
  FOLDERS runtime/plant
  SOURCES plant/toml_text.cpp plant/bus.cpp plant/can_bus.cpp plant/serial_bus.cpp plant/profibus_bus.cpp plant/profibus_port.cpp plant/profibus_control.cpp plant/read_profibus.cpp
          plant/signal.cpp plant/plant_file.cpp plant/plant_reader.cpp plant/read_bus.cpp plant/read_station.cpp
          plant/read_control.cpp plant/read_canopen_master.cpp plant/read_fault.cpp plant/read_surroundings.cpp plant/read_expect.cpp
          plant/serial_plan.cpp plant/sbus_port.cpp plant/canopen_port.cpp plant/serial_port.cpp plant/station.cpp
          plant/signal_port.cpp plant/station_state.cpp plant/variable_names.cpp plant/station_signals.cpp
          plant/plant_signals.cpp plant/surroundings.cpp plant/plant.cpp plant/hands.cpp plant/trace_hash.cpp
  USES unit vm image bus port scom drive positioning motion storage stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_runtime SIZE 20 HOT plant/sbus_port.cpp plant/station.cpp plant/surroundings.cpp plant/plant.cpp)
