# The suites as Windows programs (docs/inside/checks.md has the table): GoogleTest out of Debian's sources, folders without those that
# start programs, and of each suite the sources that need nothing Windows or Debian's cross compiler lacks.
if(NOT EXISTS /usr/src/googletest/googletest)
  message(FATAL_ERROR "the suites for Windows need the sources of GoogleTest (Debian: googletest)")
endif()
add_subdirectory(/usr/src/googletest/googletest ${CMAKE_CURRENT_BINARY_DIR}/googletest EXCLUDE_FROM_ALL)
set(ipos_wine WINEPREFIX=${PROJECT_BINARY_DIR}/wine WINEDEBUG=-all WINEDLLOVERRIDES=mscoree,mshtml=)
# `campaign` counts the heap by a function of glibc.
set(folders harness stdlib compiler format language vm runtime generated engines bench)

# Debian has rapidcheck for its own processors only; the others are processes, pipes, rights of files and folders of POSIX.
set(ipos_not_for_windows "<rapidcheck|<sys/(wait|stat|resource|socket)|<fcntl|popen\\(|mkdtemp\\(")

# ipos_for_windows(VARIABLE source...): those of them that are.
function(ipos_for_windows variable)
  set(kept "")
  foreach(source ${ARGN})
    file(STRINGS ${source} needs REGEX "${ipos_not_for_windows}" LIMIT_COUNT 1)
    if(NOT needs)
      list(APPEND kept ${source})
    endif()
  endforeach()
  set(${variable} ${kept} PARENT_SCOPE)
endfunction()
