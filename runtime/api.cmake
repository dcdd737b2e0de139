# The library for others (cmake/embedded_library.cmake) in the size this build is configured for. The layer `api`
# exists to hold the include arrows.
set(IPOS_VARIABLES 1024 CACHE STRING "H variables a machine of the library can have (512 or 1024)")
set(IPOS_PROGRAM_WORDS 16384 CACHE STRING "longest program of the library, in code words")
option(IPOS_FAST "the library has the fast engine" ON)

ipos_embedded_library(ipos_embedded STATIC VARIABLES ${IPOS_VARIABLES} WORDS ${IPOS_PROGRAM_WORDS} FAST ${IPOS_FAST})
set_target_properties(ipos_embedded PROPERTIES OUTPUT_NAME ipos EXPORT_NAME ipos ARCHIVE_OUTPUT_DIRECTORY
                      ${PROJECT_BINARY_DIR}/lib)
add_library(ipos::ipos ALIAS ipos_embedded)

if(NOT IPOS_LIBRARY_ONLY)
  ipos_layer(api FOLDERS runtime/api
             SOURCES api/status.cpp api/program.cpp api/instance.cpp api/host_bridge.cpp api/saved.cpp
             USES vm image scom stdlib)
  ipos_embedded_library(ipos_shared SHARED VARIABLES ${IPOS_VARIABLES} WORDS ${IPOS_PROGRAM_WORDS} FAST ${IPOS_FAST})
  set_target_properties(ipos_shared PROPERTIES OUTPUT_NAME ipos EXPORT_NAME shared VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  add_library(ipos::shared ALIAS ipos_shared)

  # The compiler as a library, for hosts: what it is made of stays inside.
  add_library(ipos_compile SHARED ${CMAKE_CURRENT_LIST_DIR}/api/compile.cpp)
  target_link_libraries(ipos_compile PRIVATE $<BUILD_INTERFACE:ipos_options> $<BUILD_INTERFACE:ipos::compiler>
                        $<BUILD_INTERFACE:ipos::image> PUBLIC ipos_shared)
  target_include_directories(ipos_compile PRIVATE ${PROJECT_SOURCE_DIR})
  target_compile_options(ipos_compile PRIVATE -fvisibility=hidden)
  target_link_options(ipos_compile PRIVATE LINKER:--exclude-libs,ALL)
  set_target_properties(ipos_compile PROPERTIES EXPORT_NAME compile VERSION ${PROJECT_VERSION}
                        SOVERSION ${PROJECT_VERSION_MAJOR} LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)
  add_library(ipos::compile ALIAS ipos_compile)
endif()
