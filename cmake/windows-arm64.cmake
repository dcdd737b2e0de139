# Toolchain file: Windows on ARM64, compiled and not linked. Debian has no libraries for it; clang compiles with the headers of
# the cross compiler for x86-64 (g++-mingw-w64-x86-64-posix), of which only what a processor is called differs. The preset
# `windows-arm64` uses it; whoever has a whole tool chain (llvm-mingw, or Visual Studio with clang) takes that in place of this file.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR ARM64)
set(CMAKE_C_COMPILER clang)
set(CMAKE_CXX_COMPILER clang++)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_C_COMPILER_TARGET aarch64-w64-mingw32)
set(CMAKE_CXX_COMPILER_TARGET aarch64-w64-mingw32)
include(${CMAKE_CURRENT_LIST_DIR}/compile_only.cmake)

execute_process(COMMAND x86_64-w64-mingw32-g++-posix -print-libgcc-file-name OUTPUT_VARIABLE gcc OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
get_filename_component(gcc ${gcc} DIRECTORY)
set(CMAKE_C_STANDARD_INCLUDE_DIRECTORIES /usr/x86_64-w64-mingw32/include)
set(CMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES ${gcc}/include/c++ ${gcc}/include/c++/x86_64-w64-mingw32 ${gcc}/include/c++/backward
    /usr/x86_64-w64-mingw32/include)
set(CMAKE_CXX_FLAGS_INIT -nostdinc++)

set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
