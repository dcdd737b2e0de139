# Stations, which are units on lines; the lines themselves, and the controls on them.
file(GLOB kinds_of_bus CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/station/*_bus.cpp)  # a row of bus_kinds.def each
ipos_layer(station
  FOLDERS runtime/station
  SOURCES station/bus.cpp ${kinds_of_bus} station/control.cpp station/plant_parts.cpp station/dp_slaves.cpp station/profibus_port.cpp station/profibus_control.cpp station/fms_control.cpp station/fms_operator.cpp station/gateway.cpp
          station/sbus_port.cpp station/canopen_port.cpp station/serial_port.cpp station/station.cpp
  USES plant_file unit vm image bus scom drive positioning motion storage stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_station SIZE 20 HOT station/sbus_port.cpp station/station.cpp)
