# Virtual time, and the buses on it. The bus knows nothing of drives.

ipos_layer(clock FOLDERS runtime/clock SOURCES clock/event_queue.cpp)
ipos_layer(bus FOLDERS runtime/bus
           SOURCES bus/line_load.cpp
                   bus/can/frame_bits.cpp bus/can/transfer.cpp bus/can/line.cpp bus/log/candump.cpp
                   bus/movilink/parameter_telegram.cpp bus/movilink/return_code.cpp
                   bus/movilink/variable_telegram.cpp bus/movilink/unit_servers.cpp bus/movilink/sbus_slave.cpp bus/movilink/sbus_master.cpp
                   bus/rs485/levels.cpp bus/rs485/line.cpp bus/log/serial_log.cpp
                   bus/movilink/serial_telegram.cpp bus/movilink/serial_receiver.cpp bus/movilink/handshake.cpp
                   bus/movilink/serial_slave.cpp bus/movilink/serial_requester.cpp bus/movilink/serial_master.cpp
                   bus/movilink/master_slave.cpp bus/movilink/line_check.cpp
           USES clock stdlib LIBS fmt::fmt)
