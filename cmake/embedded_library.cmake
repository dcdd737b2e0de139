# ipos_embedded_library(NAME STATIC|SHARED VARIABLES n WORDS n FAST 0|1): the library for others, the VM in C without heap.
# Its source is the file that firmware takes, ipos.c, for a host as for a microcontroller. FAST adds the fast engine.
include(cmake/host_commands.cmake)

# The file for firmware with its header, and beside it what build systems for firmware ask for.
set(ipos_firmware ${PROJECT_BINARY_DIR}/firmware)
file(GLOB firmware_parts CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/embed/core/*)
set(firmware_tables vm/isa/opcodes.def vm/isa/keywords.def vm/isa/blocks.def vm/verify/rules.def vm/exec/compare_modes.def
    stdlib/sbus_telegrams.def stdlib/unit_families.def stdlib/unit_types.def stdlib/system_variables.def
    embed/include/ipos.h cmake/host_commands.cmake cmake/firmware_file.cmake)
list(TRANSFORM firmware_tables PREPEND ${PROJECT_SOURCE_DIR}/)
add_custom_command(OUTPUT ${ipos_firmware}/ipos.c ${ipos_firmware}/ipos.h
  COMMAND ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUT=${ipos_firmware}
          -P ${PROJECT_SOURCE_DIR}/cmake/firmware_file.cmake
  DEPENDS ${firmware_parts} ${firmware_tables} VERBATIM COMMENT "Writing firmware/ipos.c")
add_custom_target(ipos_firmware_file DEPENDS ${ipos_firmware}/ipos.c)

set(fast_sources embed/fast.cpp vm/isa/coding.cpp vm/isa/blocks.cpp vm/verify/verify.cpp vm/fast/predecode.cpp
    vm/fast/engine.cpp)
list(TRANSFORM fast_sources PREPEND ${PROJECT_SOURCE_DIR}/)
if(NOT IPOS_LIBRARY_ONLY)  # the engine of the layer: it knows no size of vm/host/build.hpp
  list(POP_BACK fast_sources)
  list(APPEND fast_sources $<TARGET_OBJECTS:ipos_engine>)
endif()

function(ipos_embedded_library name kind)
  cmake_parse_arguments(BUILD "" "VARIABLES;WORDS;FAST" "" ${ARGN})
  add_library(${name} ${kind} ${ipos_firmware}/ipos.c)
  add_dependencies(${name} ipos_firmware_file)
  set_target_properties(${name} PROPERTIES IPOS_FUZZED ON UNITY_BUILD OFF)  # as in vm/CMakeLists.txt
  if(BUILD_FAST)
    target_sources(${name} PRIVATE ${fast_sources})
    target_compile_definitions(${name} PRIVATE IPOS_LABEL_ALIGNMENT=0
                               IPOS_THREADED=$<AND:$<BOOL:${IPOS_THREADED}>,$<CXX_COMPILER_ID:GNU,Clang>>)
    target_compile_options(${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fno-gcse>)
  endif()
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}
                             PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/embed/include>
                                    $<BUILD_INTERFACE:${ipos_written_headers}>
                                    $<INSTALL_INTERFACE:include>)
  target_compile_definitions(${name} PRIVATE NDEBUG IPOS_PROGRAM_WORDS=${BUILD_WORDS} IPOS_FAST=$<BOOL:${BUILD_FAST}>
                             PUBLIC IPOS_VARIABLES=${BUILD_VARIABLES})
  target_compile_options(${name} PRIVATE -fvisibility=hidden -ffunction-sections -fdata-sections
                         $<$<COMPILE_LANGUAGE:C>:-pedantic -Wno-sign-conversion>
                         $<$<COMPILE_LANGUAGE:CXX>:-fno-exceptions -fvisibility-inlines-hidden -fno-threadsafe-statics>)
  if(NOT IPOS_SANITIZE)  # which look at run-time types
    target_compile_options(${name} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fno-rtti>)
  endif()
  set_target_properties(${name} PROPERTIES C_STANDARD 99 C_EXTENSIONS OFF)
  target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:ipos_options>)
endfunction()
