# ipos_batches(TARGET [SIZE n] [HOT source...] [ALONE source...]): in the optimised builds of g++ and emscripten, in a first look
# (preset demo) and in builds with sanitizers several sources of a library or a test are compiled in one go, n at most. Most of the
# time of a small source goes into the headers, which a batch reads once. Names of anonymous namespaces differ in a batch. HOT
# sources are what every millisecond and every frame goes through: each is compiled by itself, so that its neighbours do not change
# what is inlined into it; not in a first look. ALONE sources are in no batch at all.
#
# In a first look and with sanitizers the sources of all other libraries are compiled so, too (CMAKE_UNITY_BUILD).
#
# The daily build (preset dev) compiles each source alone, so that a change of one costs one; the preset `clang` does so,
# too. A batch of clang says nothing about names that hide those of another source.
function(ipos_batches target)
  cmake_parse_arguments(BATCH "" "SIZE" "HOT;ALONE" ${ARGN})
  if(NOT BATCH_SIZE)
    set(BATCH_SIZE 10)
  endif()
  if(IPOS_SANITIZE OR (CMAKE_BUILD_TYPE STREQUAL Release AND (CMAKE_CXX_COMPILER_ID STREQUAL GNU OR EMSCRIPTEN)))
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${BATCH_SIZE})
    set_source_files_properties(${BATCH_ALONE} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    if(IPOS_OPTIMISE)
      set_source_files_properties(${BATCH_HOT} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
    endif()
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>)
  endif()
endfunction()

# ipos_not_hot(TARGET [SIZE n] [BUSY]): batches, and the optimiser does less. Not for what executes programs, drives and
# buses. In builds with sanitizers the optimiser does nothing, as what they add is most of the time to optimise. Two things
# are optimised there, too: what is BUSY, which the suites call very often, and all in a build for campaigns of fuzzing alone.
function(ipos_not_hot target)
  cmake_parse_arguments(COLD "BUSY" "" "" ${ARGN})
  ipos_batches(${target} ${COLD_UNPARSED_ARGUMENTS})
  if(IPOS_SANITIZE AND IPOS_TESTS AND NOT COLD_BUSY)
    target_compile_options(${target} PRIVATE -O0)
  elseif(EMSCRIPTEN)  # small, as it has to be sent
    target_compile_options(${target} PRIVATE -Os)
  elseif(NOT IPOS_OPTIMISE)
    target_compile_options(${target} PRIVATE -O0)
  elseif(NOT IPOS_SANITIZE)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
endfunction()
