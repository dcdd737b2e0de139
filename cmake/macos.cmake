# Toolchain file: macOS, compiled with clang and not linked, without anything of Apple. The layers that know no operating system
# are compiled with the headers of newlib (Debian: libstdc++-arm-none-eabi-newlib), which are of no system either, and with the
# sizes and types of Apple's processors. What includes headers of POSIX or Apple is not compiled: the ports, the files of
# memories, the program. The presets `macos-arm64` and `macos-x86_64` use it; on a Mac itself no toolchain file is needed.
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_SYSTEM_PROCESSOR ${IPOS_PROCESSOR})
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES IPOS_PROCESSOR)
set(CMAKE_C_COMPILER clang)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_C_COMPILER_TARGET ${CMAKE_SYSTEM_PROCESSOR}-apple-macos12)
set(CMAKE_CXX_COMPILER_TARGET ${CMAKE_SYSTEM_PROCESSOR}-apple-macos12)
set(CMAKE_INSTALL_NAME_TOOL true)
include(${CMAKE_CURRENT_LIST_DIR}/compile_only.cmake)

execute_process(COMMAND clang -print-resource-dir OUTPUT_VARIABLE clang OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
file(GLOB standard /usr/include/newlib/c++/*)
set(CMAKE_C_STANDARD_INCLUDE_DIRECTORIES ${clang}/include /usr/include/newlib)
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${standard} ${standard}/arm-none-eabi ${standard}/backward ${clang}/include /usr/include/newlib)
set(CMAKE_C_FLAGS_INIT -nostdinc)
set(CMAKE_CXX_FLAGS_INIT "-nostdinc -nostdinc++")
