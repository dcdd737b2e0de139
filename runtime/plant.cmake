# A plant: stations, which are units on lines, and their surroundings.
file(GLOB kinds_of_bus CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/plant/*_bus.cpp)  # a row of bus_kinds.def each
ipos_layer(runtime
  FOLDERS runtime/plant
  SOURCES plant/bus.cpp ${kinds_of_bus} plant/profibus_port.cpp plant/profibus_control.cpp plant/gateway.cpp plant/gateway_signals.cpp
          plant/sbus_port.cpp plant/canopen_port.cpp plant/serial_port.cpp plant/station.cpp
          plant/signal_port.cpp plant/station_state.cpp plant/variable_names.cpp plant/station_signals.cpp
          plant/telegram_signals.cpp plant/can_telegrams.cpp plant/serial_telegrams.cpp
          plant/profibus_telegrams.cpp plant/plant_signals.cpp plant/surroundings.cpp plant/plant.cpp
          plant/all_mistakes.cpp plant/hands.cpp plant/trace_hash.cpp
  USES plant_file unit vm image bus scom drive positioning motion storage stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_runtime SIZE 20 HOT plant/sbus_port.cpp plant/station.cpp plant/surroundings.cpp plant/plant.cpp)
