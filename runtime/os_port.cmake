# Real ports of a Linux host, and real time. The rest of the runtime does not know them.
if(CMAKE_SYSTEM_NAME STREQUAL Linux)
  ipos_layer(os_port FOLDERS runtime/os_port
             SOURCES os_port/port_error.cpp os_port/port_notes.cpp os_port/port_names.cpp os_port/system_clock.cpp
                     os_port/can_port.cpp os_port/can_error_frame.cpp os_port/can_link.cpp os_port/socket_can.cpp
                     os_port/slcan_text.cpp os_port/slcan_client.cpp os_port/slcan_adapter.cpp os_port/tty.cpp os_port/tty_rate.cpp
                     os_port/pty.cpp os_port/serial_port.cpp os_port/can_bridge.cpp os_port/byte_bridge.cpp
                     os_port/serial_bridge.cpp os_port/profibus_bridge.cpp os_port/real_time.cpp
             USES clock bus LIBS fmt::fmt)
  ipos_not_hot(ipos_os_port)
endif()
