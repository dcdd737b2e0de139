# ipos_batches(TARGET): in the optimised build of g++ several sources of a library are compiled in one go. Most of the time
# of a small source goes into the headers, which a batch reads once. Names of anonymous namespaces differ in a folder.
#
# The daily build (preset dev) compiles each source alone, so that a change of one costs one; clang does so, too.
function(ipos_batches target)
  if(CMAKE_BUILD_TYPE STREQUAL Release AND CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 10)
  endif()
endfunction()

# ipos_not_hot(TARGET): batches, and the optimiser does less. Not for what executes programs, drives and buses.
function(ipos_not_hot target)
  ipos_batches(${target})
  target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()
