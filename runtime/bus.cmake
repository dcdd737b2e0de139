# Virtual time, and the buses on it. The bus knows nothing of drives.

ipos_layer(clock FOLDERS runtime/clock SOURCES clock/event_queue.cpp)
ipos_layer(bus FOLDERS runtime/bus
           SOURCES bus/line/line_load.cpp
                   bus/can/identifier_text.cpp bus/can/frame_bits.cpp bus/can/bit_error.cpp bus/can/line_fault.cpp
                   bus/can/transfer.cpp
                   bus/can/line.cpp bus/can/line_wiring.cpp bus/can/line_report.cpp bus/can/contenders.cpp
                   bus/log/candump.cpp
                   bus/canopen/abort.cpp bus/canopen/object_dictionary.cpp bus/canopen/object_access.cpp
                   bus/canopen/eds.cpp bus/canopen/sdo_server.cpp bus/canopen/pdo.cpp bus/canopen/emergency.cpp
                   bus/canopen/error_control.cpp bus/canopen/node.cpp bus/canopen/sdo_client.cpp bus/canopen/master.cpp
                   bus/canopen/sdo_master.cpp bus/canopen/dbc_messages.cpp bus/canopen/words.cpp bus/canopen/sdo_words.cpp bus/words/can_words.cpp bus/words/bus_words.cpp
                   bus/movilink/parameter_telegram.cpp bus/movilink/return_code.cpp
                   bus/movilink/variable_telegram.cpp bus/movilink/profile.cpp bus/movilink/unit_servers.cpp
                   bus/movilink/sbus_slave.cpp bus/movilink/sbus_master.cpp bus/movilink/sbus_group_master.cpp
                   bus/movilink/sbus_control.cpp bus/movilink/gateway_channel.cpp bus/movilink/sbus_check.cpp bus/movilink/process_words.cpp
                   bus/movilink/unit_words.cpp bus/movilink/telegram_words.cpp bus/movilink/describe.cpp
                   bus/movilink/describe_serial.cpp bus/movilink/station_filter.cpp bus/dbc/dbc.cpp bus/movilink/dbc_signals.cpp
                   bus/log/bus_load.cpp bus/log/replay.cpp
                   bus/rs485/levels.cpp bus/rs485/line.cpp bus/log/serial_log.cpp bus/log/profibus_log.cpp bus/log/read_serial_log.cpp
                   bus/movilink/serial_telegram.cpp bus/movilink/serial_receiver.cpp bus/movilink/handshake.cpp
                   bus/movilink/serial_slave.cpp bus/movilink/serial_requester.cpp bus/movilink/serial_master.cpp
                   bus/movilink/master_slave.cpp bus/movilink/line_check.cpp
                   bus/profibus/fdl_frame.cpp bus/profibus/fdl_receiver.cpp bus/profibus/dp_service.cpp
                   bus/profibus/cfg_data.cpp bus/profibus/frame_text.cpp bus/profibus/dp_slave.cpp bus/profibus/card.cpp
                   bus/profibus/line_fault.cpp bus/profibus/line.cpp bus/profibus/slave_station.cpp
                   bus/profibus/slave_handler.cpp bus/profibus/master.cpp bus/profibus/fieldbus_parameters.cpp
                   bus/profibus/dp_unit.cpp bus/profibus/gsd.cpp bus/profibus/line_plan.cpp bus/profibus/interface_card.cpp bus/profibus/fms_connection.cpp
                   bus/profibus/fms_objects.cpp bus/profibus/fms_server.cpp
           USES clock stdlib LIBS fmt::fmt)
ipos_batches(ipos_bus SIZE 40
             HOT bus/can/frame_bits.cpp bus/can/transfer.cpp bus/can/line.cpp bus/can/contenders.cpp
                 bus/movilink/variable_telegram.cpp bus/movilink/sbus_slave.cpp bus/movilink/sbus_group_master.cpp
                 bus/rs485/line.cpp)
