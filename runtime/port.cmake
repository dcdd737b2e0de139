# Real ports of a Linux host, and real time. The rest of the runtime does not know them.
if(CMAKE_SYSTEM_NAME STREQUAL Linux)
  ipos_layer(port FOLDERS runtime/port
             SOURCES port/port_error.cpp port/port_notes.cpp port/port_names.cpp port/system_clock.cpp port/can_port.cpp port/can_error_frame.cpp
                     port/can_link.cpp port/socket_can.cpp port/slcan_text.cpp port/slcan_client.cpp
                     port/slcan_adapter.cpp port/tty.cpp port/pty.cpp port/serial_port.cpp port/can_bridge.cpp port/serial_bridge.cpp port/profibus_bridge.cpp
                     port/real_time.cpp
             USES clock bus LIBS fmt::fmt)
  ipos_not_hot(ipos_port)
endif()
