# The plant as a library: libipos_plant with the C functions of ipos_plant.h, of which Python is made (python/). The layer
# is what C++ sees of it. Machine code (vm/jit) is not in it: Debian's asmjit cannot go into a shared library.
ipos_layer(library
  FOLDERS runtime/library
  SOURCES library/contents.cpp library/signal_id.cpp library/bus_tap.cpp library/can_nodes.cpp library/action.cpp library/instance.cpp
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
# What it shows are the functions of its header, and nothing of C++.
set(exports ${CMAKE_CURRENT_LIST_DIR}/library/exports.map)
if(WIN32)
  set(header ${CMAKE_CURRENT_LIST_DIR}/library/include/ipos_plant.h)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${header})
  file(STRINGS ${header} functions REGEX "^[a-z].* \\*?ipos_plant_[a-z_]+\\(")
  list(TRANSFORM functions REPLACE ".* \\*?(ipos_plant_[a-z_]+)\\(.*" "\\1")
  list(JOIN functions "\n" functions)
  set(exports ${PROJECT_BINARY_DIR}/lib/ipos_plant.def)
  file(CONFIGURE OUTPUT ${exports} CONTENT "LIBRARY ipos_plant.dll\nEXPORTS\n@functions@\n" @ONLY)
endif()
add_library(ipos_plant SHARED $<TARGET_OBJECTS:ipos_plant_functions>)
target_link_libraries(ipos_plant PRIVATE $<BUILD_INTERFACE:ipos_options> $<BUILD_INTERFACE:ipos::library>)
target_include_directories(ipos_plant PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_LIST_DIR}/library/include>
                                             $<INSTALL_INTERFACE:include>)
if(WIN32)
  target_sources(ipos_plant PRIVATE ${exports})
else()
  target_link_options(ipos_plant PRIVATE LINKER:--version-script=${exports} LINKER:--as-needed)
endif()
# A shared library that goes elsewhere, without what a Debian system has beside it: {fmt} comes out of its headers.
function(ipos_stands_alone target)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL GNU OR IPOS_SANITIZE OR IPOS_COVERAGE OR WIN32)
    return()
  endif()
  target_link_options(${target} PRIVATE -static-libstdc++ -static-libgcc)
  if(EXISTS /usr/include/fmt/format-inl.h)
    target_sources(${target} PRIVATE ${PROJECT_SOURCE_DIR}/tools/static/fmt.cpp)
  endif()
endfunction()
ipos_stands_alone(ipos_plant)
set_target_properties(ipos_plant PROPERTIES EXPORT_NAME plant VERSION ${PROJECT_VERSION} LINKER_LANGUAGE CXX
                      SOVERSION ${PROJECT_VERSION_MAJOR} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
                      LINK_DEPENDS ${exports})
if(WIN32)
  set_target_properties(ipos_plant PROPERTIES PREFIX "" SOVERSION "" VERSION "" RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib
                        ARCHIVE_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
endif()
add_library(ipos::plant ALIAS ipos_plant)
