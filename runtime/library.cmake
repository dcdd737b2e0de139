# The plant as a library: libipos_plant with the C functions of ipos_plant.h, of which Python is made (python/). The layer
# is what C++ sees of it. Machine code (vm/jit) is not in it: Debian's asmjit cannot go into a shared library.
ipos_layer(library
  FOLDERS runtime/library
  SOURCES library/contents.cpp library/signal_id.cpp library/bus_tap.cpp library/action.cpp library/instance.cpp
          library/session.cpp
  USES runtime compiler stdlib
  LIBS fmt::fmt)
ipos_not_hot(ipos_library)

set(functions api_plant.cpp api_signals.cpp api_buses.cpp api_parameters.cpp)
list(TRANSFORM functions PREPEND ${CMAKE_CURRENT_LIST_DIR}/library/)
add_library(ipos_plant_functions OBJECT ${functions})
target_link_libraries(ipos_plant_functions PRIVATE ipos_options fmt::fmt PUBLIC ipos::library)
target_include_directories(ipos_plant_functions PUBLIC ${CMAKE_CURRENT_LIST_DIR}/library/include)
ipos_for_shared_libraries(ipos_plant_functions)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # g++ 12 thinks the value of a tl::expected that holds an error is read.
  target_compile_options(ipos_plant_functions PRIVATE -Wno-maybe-uninitialized)
endif()

if(EMSCRIPTEN)  # which has no shared libraries
  return()
endif()
set(exports ${CMAKE_CURRENT_LIST_DIR}/library/exports.map)
add_library(ipos_plant SHARED $<TARGET_OBJECTS:ipos_plant_functions>)
target_link_libraries(ipos_plant PRIVATE $<BUILD_INTERFACE:ipos_options> $<BUILD_INTERFACE:ipos::library>)
target_include_directories(ipos_plant PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_LIST_DIR}/library/include>
                                             $<INSTALL_INTERFACE:include>)
target_link_options(ipos_plant PRIVATE LINKER:--version-script=${exports} LINKER:--as-needed)
# A wheel has it alone, without what a Debian system has beside it: {fmt} comes out of its headers.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT IPOS_SANITIZE AND NOT IPOS_COVERAGE)
  target_link_options(ipos_plant PRIVATE -static-libstdc++ -static-libgcc)
  if(EXISTS /usr/include/fmt/format-inl.h)
    target_sources(ipos_plant PRIVATE ${PROJECT_SOURCE_DIR}/tools/static/fmt.cpp)
  endif()
endif()
set_target_properties(ipos_plant PROPERTIES EXPORT_NAME plant VERSION ${PROJECT_VERSION} LINKER_LANGUAGE CXX
                      SOVERSION ${PROJECT_VERSION_MAJOR} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
                      LINK_DEPENDS ${exports})
add_library(ipos::plant ALIAS ipos_plant)
