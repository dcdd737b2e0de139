# ipos_embedded_library(NAME STATIC|SHARED VARIABLES n WORDS n FAST 0|1): the library for others, the VM without heap,
# the variable telegrams and the C API in one. Its sources are those of the layers, compiled once more without
# exceptions and run-time types, for the host as for a microcontroller.
include(cmake/host_commands.cmake)
set(embedded_sources
    vm/isa/coding.cpp vm/isa/blocks.cpp vm/image/view.cpp vm/verify/verify.cpp vm/exec/machine.cpp vm/exec/interrupts.cpp
    vm/exec/saved_state.cpp
    stdlib/unit_types.cpp runtime/bus/movilink/variable_telegram.cpp runtime/scom/object_table.cpp
    embed/status.cpp embed/program.cpp embed/instance.cpp embed/host_bridge.cpp
    embed/saved.cpp)
set(fast_sources vm/fast/predecode.cpp vm/fast/engine.cpp)
list(TRANSFORM embedded_sources PREPEND ${PROJECT_SOURCE_DIR}/)
list(TRANSFORM fast_sources PREPEND ${PROJECT_SOURCE_DIR}/)
if(NOT IPOS_LIBRARY_ONLY)  # the engine of the layer: it knows no size of vm/host/build.hpp
  list(POP_BACK fast_sources)
  list(APPEND fast_sources $<TARGET_OBJECTS:ipos_engine>)
endif()

function(ipos_embedded_library name kind)
  cmake_parse_arguments(BUILD "" "VARIABLES;WORDS;FAST" "" ${ARGN})
  add_library(${name} ${kind} ${embedded_sources})
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
  target_compile_options(${name} PRIVATE -fno-exceptions
                         -fvisibility=hidden -fvisibility-inlines-hidden -ffunction-sections -fdata-sections
                         -fno-threadsafe-statics)
  if(NOT IPOS_SANITIZE)  # which look at run-time types
    target_compile_options(${name} PRIVATE -fno-rtti)
  endif()
  target_link_libraries(${name} PRIVATE $<BUILD_INTERFACE:ipos_options>)
endfunction()
