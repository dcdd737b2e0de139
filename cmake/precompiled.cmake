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

function(ipos_precompiled target)
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    set(kind plain)
    if("PIC" IN_LIST ARGN)
      set(kind pic)
    endif()
    target_precompile_headers(${target} REUSE_FROM ipos_precompiled_${kind})
  endif()
endfunction()
