# Non-volatile memory as bytes on a medium: two slots, checksums, what a power cut leaves behind.
if(WIN32)
  set(medium nv_memory/medium/windows_medium.cpp)
else()
  set(medium nv_memory/medium/posix_medium.cpp)
endif()
ipos_layer(storage FOLDERS runtime/nv_memory/medium
           SOURCES nv_memory/medium/nv_content.cpp nv_memory/medium/slot_store.cpp nv_memory/medium/file_copy.cpp ${medium}
           USES image LIBS fmt::fmt)
