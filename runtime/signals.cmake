# Values of a plant that have a name: found, read, shown and written in one place for every front end.
ipos_layer(signals
  FOLDERS runtime/signals
  SOURCES signals/signal.cpp signals/collector.cpp signals/variables.cpp signals/parameters.cpp signals/terminals.cpp
          signals/states.cpp signals/card.cpp signals/words.cpp signals/drive_values.cpp signals/tasks.cpp signals/gateways.cpp
          signals/telegrams.cpp signals/can_telegrams.cpp signals/serial_telegrams.cpp signals/profibus_telegrams.cpp
          signals/patterns.cpp signals/shape.cpp signals/find.cpp signals/find_in_plant.cpp signals/holds.cpp signals/physical_units.cpp
  USES station stdlib
  LIBS fmt::fmt)
ipos_batches(ipos_signals SIZE 20)
