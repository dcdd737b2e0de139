# For toolchain files of systems that this one has headers for, but no libraries: everything is compiled, nothing is linked. What
# a build calls a program or a library is an empty file. CMake reads it once more for each language, behind its own rules.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_USER_MAKE_RULES_OVERRIDE ${CMAKE_CURRENT_LIST_DIR}/compile_only.cmake)
foreach(language C CXX)
  foreach(rule LINK_EXECUTABLE CREATE_SHARED_LIBRARY CREATE_SHARED_MODULE CREATE_STATIC_LIBRARY)
    set(CMAKE_${language}_${rule} "<CMAKE_COMMAND> -E touch <TARGET>")
  endforeach()
  foreach(rule ARCHIVE_CREATE ARCHIVE_APPEND ARCHIVE_FINISH)
    unset(CMAKE_${language}_${rule})
  endforeach()
endforeach()
