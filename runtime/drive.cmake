# The drive: parameters and unit state. It knows nothing of buses.
ipos_layer(drive FOLDERS runtime/drive
           SOURCES drive/parameters.cpp drive/unit_state.cpp drive/error_memory.cpp
           USES stdlib LIBS fmt::fmt)
