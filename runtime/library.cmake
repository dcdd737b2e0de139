# The plant as a library: libipos_plant with the C functions of ipos_plant.h, of which Python is made (python/). The layer
# is what C++ sees of it. Machine code (vm/jit) is not in it: Debian's asmjit cannot go into a shared library.
ipos_layer(library
  FOLDERS runtime/library
  SOURCES library/contents.cpp library/place.cpp library/bus_tap.cpp library/deed.cpp library/world.cpp
          library/session.cpp
  USES runtime compiler stdlib
  LIBS fmt::fmt)
ipos_not_hot(ipos_library)

set(api_sources api_plant.cpp api_signals.cpp api_buses.cpp)
list(TRANSFORM api_sources PREPEND ${CMAKE_CURRENT_LIST_DIR}/library/)
add_library(ipos_plant SHARED ${api_sources})
target_link_libraries(ipos_plant PRIVATE $<BUILD_INTERFACE:ipos_options> $<BUILD_INTERFACE:ipos::library>
                                         $<BUILD_INTERFACE:fmt::fmt>)
target_include_directories(ipos_plant PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_LIST_DIR}/library/include>
                                             $<INSTALL_INTERFACE:include>)
target_compile_options(ipos_plant PRIVATE -fvisibility=hidden)
set(exports ${CMAKE_CURRENT_LIST_DIR}/library/exports.map)
target_link_options(ipos_plant PRIVATE LINKER:--version-script=${exports} LINKER:--as-needed)
set_property(TARGET ipos_plant PROPERTY LINK_DEPENDS ${exports})
set_target_properties(ipos_plant PROPERTIES EXPORT_NAME plant VERSION ${PROJECT_VERSION}
                      SOVERSION ${PROJECT_VERSION_MAJOR} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
add_library(ipos::plant ALIAS ipos_plant)
