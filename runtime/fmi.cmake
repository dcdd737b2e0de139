# A plant as an FMU: the layer makes variables of signals and answers for them; libipos_fmu has the functions of FMI 2.0 and 3.0, one
# library for both. `ipos fmu` puts it into the FMU under the name that its description says.
ipos_layer(fmi
  FOLDERS runtime/fmi
  SOURCES fmi/names.cpp fmi/types.cpp fmi/variables.cpp fmi/package.cpp fmi/resources.cpp fmi/instance.cpp fmi/saved.cpp fmi/can_operations.cpp
          fmi/bus_terminal.cpp fmi/line_terminal.cpp fmi/terminals.cpp
          fmi/component.cpp
  USES library
  LIBS fmt::fmt)
ipos_not_hot(ipos_fmi)

set(functions fmi2.cpp fmi3.cpp fmi3_clocks.cpp)
list(TRANSFORM functions PREPEND ${CMAKE_CURRENT_LIST_DIR}/fmi/)
add_library(ipos_fmu_functions OBJECT ${functions})
target_link_libraries(ipos_fmu_functions PRIVATE ipos_options PUBLIC ipos::fmi)
ipos_for_shared_libraries(ipos_fmu_functions)

if(EMSCRIPTEN)  # which has no shared libraries
  return()
endif()
set(exports ${CMAKE_CURRENT_LIST_DIR}/fmi/exports.map)
add_library(ipos_fmu SHARED $<TARGET_OBJECTS:ipos_fmu_functions>)
target_link_libraries(ipos_fmu PRIVATE ipos_options ipos::fmi)
if(NOT WIN32)  # there the functions say themselves that they are shown
  target_link_options(ipos_fmu PRIVATE LINKER:--version-script=${exports} LINKER:--as-needed)
endif()
ipos_stands_alone(ipos_fmu)
target_link_options(ipos_fmu PRIVATE $<$<CONFIG:Release>:-s>)  # FMUs are handed around
set_target_properties(ipos_fmu PROPERTIES LINKER_LANGUAGE CXX LINK_DEPENDS ${exports} NO_SONAME ON
                      LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
                      ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
if(WIN32)
  set_target_properties(ipos_fmu PROPERTIES PREFIX "")
endif()
