# Real ports, and real time. The rest of the runtime does not know them. Windows has serial devices and adapters, a browser none.
set(ports os_port/port_error.cpp os_port/port_notes.cpp os_port/can_port.cpp os_port/can_error_frame.cpp
          os_port/slcan_text.cpp os_port/slcan_client.cpp os_port/serial_port.cpp os_port/can_bridge.cpp
          os_port/returning_port.cpp os_port/adapters/adapter_names.cpp
          os_port/byte_bridge.cpp os_port/serial_bridge.cpp os_port/profibus_bridge.cpp os_port/real_time.cpp)
set(adapters os_port/adapters/adapter_channel.cpp os_port/adapters/adapter_port.cpp os_port/adapters/pcan.cpp os_port/adapters/vector.cpp
             os_port/adapters/kvaser.cpp os_port/adapters/ixxat.cpp)
if(CMAKE_SYSTEM_NAME STREQUAL Linux)
  list(APPEND ports ${adapters} os_port/shared_library.cpp os_port/system_clock.cpp os_port/port_names.cpp os_port/can_link.cpp os_port/socket_can.cpp os_port/slcan_adapter.cpp
                    os_port/tty.cpp os_port/tty_rate.cpp os_port/pty.cpp os_port/pty_port.cpp)
  # The kernel's header of rates and <termios.h> exclude each other.
  set_source_files_properties(os_port/tty_rate.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
elseif(WIN32)
  # The header of Windows has macros `near` and `far`, so it stands behind ours in a batch.
  set_source_files_properties(${adapters} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  list(APPEND ports ${adapters} os_port/windows/shared_library.cpp os_port/windows/clock.cpp os_port/windows/port_names.cpp
                    os_port/windows/serial_devices.cpp os_port/windows/tty.cpp os_port/windows/absent_ports.cpp)
  set(system_libraries winmm)
elseif(EMSCRIPTEN)
  list(APPEND ports os_port/web/clock.cpp os_port/port_names.cpp os_port/web/absent_ports.cpp)
endif()
ipos_layer(os_port FOLDERS runtime/os_port SOURCES ${ports} USES clock bus_can bus_rs485 bus_movilink bus_profibus LIBS fmt::fmt ${system_libraries})
ipos_not_hot(ipos_os_port)
