# ipos_join(NAME LAYER...): in a first look (preset demo) the sources of these layers are compiled in one go. Half of the time of
# a build without the optimiser goes into headers and templates that each layer would read and make again. All other builds
# compile each layer by itself and so keep which folders it sees; here the layers are names for the whole.
#
# The layers are of one CMakeLists.txt, which calls this at its end. Names of their anonymous namespaces differ. g++ needs up to 2 GB
# of memory for a joined source, so no more are compiled at once than the machine has memory for.
cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY)  # MiB
math(EXPR at_once "(${memory} + 1024) / 2560")
if(at_once LESS 1)
  set(at_once 1)
endif()
set_property(GLOBAL APPEND PROPERTY JOB_POOLS ipos_joined=${at_once})

function(ipos_join name)
  if(IPOS_OPTIMISE)
    return()
  endif()
  set(joined ipos_joined_${name})
  add_library(${joined} STATIC)
  set_target_properties(${joined} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0
                        JOB_POOL_COMPILE ipos_joined)
  file(CONFIGURE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/joined.cpp CONTENT "// The sources of this layer lie in a joined library.\n")
  set_source_files_properties(${CMAKE_CURRENT_BINARY_DIR}/joined.cpp PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  foreach(layer ${ARGN})
    get_target_property(sources ipos_${layer} SOURCES)
    target_sources(${joined} PRIVATE ${sources})
    set_target_properties(ipos_${layer} PROPERTIES SOURCES ${CMAKE_CURRENT_BINARY_DIR}/joined.cpp UNITY_BUILD OFF)
    foreach(property INCLUDE_DIRECTORIES COMPILE_DEFINITIONS COMPILE_OPTIONS)
      get_target_property(value ipos_${layer} ${property})
      if(value)
        set_property(TARGET ${joined} APPEND PROPERTY ${property} ${value})
      endif()
    endforeach()
    get_target_property(libraries ipos_${layer} LINK_LIBRARIES)
    list(REMOVE_ITEM libraries ipos_options)  # no warnings: the builds that compile each layer tell them
    target_link_libraries(${joined} PRIVATE ${libraries})
    target_link_libraries(ipos_${layer} PUBLIC ${joined})
  endforeach()
  list(GET ARGN 0 first)
  get_target_property(shared ipos_${first} POSITION_INDEPENDENT_CODE)
  get_target_property(header ipos_${first} PRECOMPILE_HEADERS_REUSE_FROM)
  set_target_properties(${joined} PROPERTIES POSITION_INDEPENDENT_CODE ${shared})
  target_precompile_headers(${joined} REUSE_FROM ${header})
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${joined} PRIVATE "SHELL:--param ggc-min-heapsize=1000000")  # it never tidies up: 9 % less time
  endif()
endfunction()
