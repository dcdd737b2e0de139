# Non-volatile memory as bytes on a medium: two slots, checksums, what a power cut leaves behind.
ipos_layer(storage FOLDERS runtime/nv_memory/medium
           SOURCES nv_memory/medium/nv_content.cpp nv_memory/medium/slot_store.cpp nv_memory/medium/posix_medium.cpp
           USES image LIBS fmt::fmt)
