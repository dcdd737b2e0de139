# Non-volatile memory as bytes on a medium: two slots, checksums, what a power cut leaves behind.
ipos_layer(storage FOLDERS runtime/storage
           SOURCES storage/nv_content.cpp storage/slot_store.cpp storage/posix_medium.cpp
           USES image LIBS fmt::fmt)
