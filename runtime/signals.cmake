# Values of a plant that have a name: found, read, shown and written in one place for every front end.
ipos_layer(signals
  FOLDERS runtime/signals
  SOURCES signals/signal_port.cpp signals/station_state.cpp signals/variable_names.cpp signals/station_signals.cpp
          signals/gateway_signals.cpp signals/telegram_signals.cpp signals/can_telegrams.cpp signals/serial_telegrams.cpp
          signals/profibus_telegrams.cpp signals/plant_signals.cpp
  USES station stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_signals SIZE 20)
