# Headers of others, precompiled: a third of the time of most objects went into reading them again.
#
#   ipos_precompiled(TARGET)          for a library that links fmt::fmt
#   ipos_precompiled(TARGET PIC)      for one whose code goes into a shared library as well
#
# Only g++ has them: with clang a missing #include is found.
set(ipos_precompiled_headers <fmt/format.h> <algorithm> <array> <charconv> <cstdint> <filesystem> <functional> <map>
    <memory> <optional> <set> <span> <string> <string_view> <utility> <vector>)

if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
  foreach(kind plain pic)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled_${kind}.cpp CONTENT "// A precompiled header needs an object.\n")
    add_library(ipos_precompiled_${kind} STATIC ${PROJECT_BINARY_DIR}/precompiled_${kind}.cpp)
    target_link_libraries(ipos_precompiled_${kind} PRIVATE ipos_options fmt::fmt)
    target_precompile_headers(ipos_precompiled_${kind} PRIVATE ${ipos_precompiled_headers})
  endforeach()
  set_target_properties(ipos_precompiled_pic PROPERTIES POSITION_INDEPENDENT_CODE ON)
endif()

# Out of a precompiled header g++ 12 reports what it keeps quiet about in the header itself: inlined std::string and
# replaced operators new and delete, in optimised code only.
set(ipos_false_reports "")
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  set(ipos_false_reports $<$<CONFIG:Release>:-Wno-array-bounds$<SEMICOLON>-Wno-stringop-overflow$<SEMICOLON>-Wno-stringop-overread$<SEMICOLON>-Wno-mismatched-new-delete>)
endif()

function(ipos_precompiled target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    set(kind plain)
    if("PIC" IN_LIST ARGN)
      set(kind pic)
    endif()
    target_precompile_headers(${target} REUSE_FROM ipos_precompiled_${kind})
    target_compile_options(${target} PRIVATE ${ipos_false_reports})
  endif()
endfunction()
