# Virtual time, and the buses on it. The bus knows nothing of drives.

ipos_layer(clock FOLDERS runtime/clock SOURCES clock/event_queue.cpp)

# bus_layer(NAME [FOLDER folder] [BATCH n] SOURCES file... HOT file... USES layer...): a folder of runtime/bus.
function(bus_layer name)
  cmake_parse_arguments(BUS "" "BATCH;FOLDER" "SOURCES;HOT;USES" ${ARGN})
  if(NOT BUS_BATCH)
    set(BUS_BATCH 40)
  endif()
  if(NOT BUS_FOLDER)
    set(BUS_FOLDER ${name})
  endif()
  list(TRANSFORM BUS_SOURCES PREPEND bus/${BUS_FOLDER}/)
  list(TRANSFORM BUS_HOT PREPEND bus/${BUS_FOLDER}/)
  ipos_layer(bus_${name} FOLDERS runtime/bus/${BUS_FOLDER} SOURCES ${BUS_SOURCES} ${BUS_HOT} USES ${BUS_USES} LIBS fmt::fmt)
  ipos_batches(ipos_bus_${name} SIZE ${BUS_BATCH} HOT ${BUS_HOT})
endfunction()

bus_layer(line SOURCES line_load.cpp)
bus_layer(can
  SOURCES identifier_text.cpp bit_error.cpp clash.cpp line_fault.cpp line_strangers.cpp line_wiring.cpp line_repeats.cpp line_report.cpp
  HOT frame_bits.cpp transfer.cpp line.cpp contenders.cpp standing_frames.cpp
  USES bus_line clock)
bus_layer(rs485 SOURCES levels.cpp octet_fault.cpp bit_fault.cpp line_faults.cpp HOT line.cpp USES bus_line clock)
# What a unit says on a line, and who asks it.
bus_layer(movilink BATCH 12  # SBus, and the serial line: some names are in both
  SOURCES parameter_telegram.cpp return_code.cpp profile.cpp unit_servers.cpp sbus_master.cpp sbus_control.cpp
          gateway_channel.cpp sbus_check.cpp process_words.cpp unit_words.cpp telegram_words.cpp describe.cpp
          describe_serial.cpp station_filter.cpp dbc_signals.cpp serial_telegram.cpp serial_receiver.cpp handshake.cpp
          serial_slave.cpp serial_requester.cpp serial_master.cpp master_slave.cpp line_check.cpp
  HOT variable_telegram.cpp sbus_slave.cpp sbus_group_master.cpp
  USES bus_can bus_rs485 clock stdlib)
bus_layer(canopen
  SOURCES abort.cpp object_dictionary.cpp object_access.cpp eds.cpp sdo_server.cpp pdo.cpp emergency.cpp error_control.cpp
          node.cpp sdo_client.cpp master.cpp sdo_master.cpp dbc_messages.cpp words.cpp sdo_words.cpp
  USES bus_can bus_movilink clock stdlib)
ipos_layer(bus_profibus_octets FOLDERS runtime/bus/profibus/octets)
bus_layer(profibus_fms FOLDER profibus/fms
  SOURCES connection.cpp pdu.cpp messages.cpp server.cpp slave_links.cpp client_link.cpp
  USES bus_profibus_octets bus_movilink clock stdlib)
bus_layer(profibus
  SOURCES fdl_frame.cpp fdl_receiver.cpp dp_service.cpp cfg_data.cpp frame_text.cpp dp_slave.cpp card.cpp line_fault.cpp
          line.cpp slave_station.cpp slave_handler.cpp master.cpp fieldbus_parameters.cpp dp_unit.cpp gsd.cpp line_plan.cpp
          interface_card.cpp fms_objects.cpp fms_partner.cpp
  USES bus_profibus_fms bus_line bus_rs485 bus_movilink clock stdlib)
# Telegrams of all lines as words, as logs, and as a DBC file.
bus_layer(words SOURCES can_words.cpp dp_words.cpp bus_words.cpp USES bus_can bus_movilink bus_canopen bus_profibus)
bus_layer(log
  SOURCES candump.cpp read_serial_log.cpp bus_load.cpp replay.cpp serial_log.cpp profibus_log.cpp
  USES bus_can bus_rs485 bus_movilink bus_profibus clock)
bus_layer(dbc SOURCES dbc.cpp USES bus_words bus_log bus_canopen bus_movilink bus_can stdlib)
ipos_layer(bus USES bus_line bus_can bus_rs485 bus_movilink bus_canopen bus_profibus_fms bus_profibus bus_words bus_log
           bus_dbc)  # all of them
