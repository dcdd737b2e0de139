# Headers of others, precompiled: a third of the time of most objects went into reading them again.
#
#   ipos_precompiled(TARGET)          for a layer that links fmt::fmt
#
# Only g++ has them: with clang a missing #include is found.
set(ipos_precompiled_headers <fmt/format.h> <algorithm> <array> <charconv> <cstdint> <filesystem> <functional> <map>
    <memory> <optional> <set> <span> <string> <string_view> <utility> <vector>)

# A precompiled header is for objects with its own options: in a first look (preset demo) it is not optimised, and no more are those
# that read it. The layers without it execute programs, drives and buses.
set(ipos_precompiled_options "")
if(NOT IPOS_OPTIMISE)
  set(ipos_precompiled_options -O0)
endif()

if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled_pic.cpp CONTENT "// A precompiled header needs an object.\n")
  add_library(ipos_precompiled_pic STATIC ${PROJECT_BINARY_DIR}/precompiled_pic.cpp)
  target_link_libraries(ipos_precompiled_pic PRIVATE ipos_options fmt::fmt)
  target_precompile_headers(ipos_precompiled_pic PRIVATE ${ipos_precompiled_headers})
  target_compile_options(ipos_precompiled_pic PRIVATE ${ipos_precompiled_options})
  ipos_for_shared_libraries(ipos_precompiled_pic)
endif()

# Out of a precompiled header g++ 12 reports what it keeps quiet about in the header itself: inlined std::string and
# replaced operators new and delete, in optimised code, and more with ThreadSanitizer.
set(ipos_false_reports "")
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  set(ipos_false_reports $<$<CONFIG:Release,RelWithDebInfo>:-Wno-array-bounds$<SEMICOLON>-Wno-stringop-overflow$<SEMICOLON>-Wno-stringop-overread$<SEMICOLON>-Wno-mismatched-new-delete>)
endif()

function(ipos_precompiled target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_precompile_headers(${target} REUSE_FROM ipos_precompiled_pic)
    target_compile_options(${target} PRIVATE ${ipos_false_reports} ${ipos_precompiled_options})
  endif()
endfunction()
