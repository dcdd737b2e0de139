# What a build for Windows takes from where.
set(more_headers boost)  # the server of `ipos serve`
include(cmake/header_packages.cmake)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY=1)

# Sizes of files have 64 bits; printf as the C standard says; names of Windows' own functions in UTF-16, and no macros min, max.
add_compile_definitions(_FILE_OFFSET_BITS=64 __USE_MINGW_ANSI_STDIO=1 UNICODE _UNICODE NOMINMAX WIN32_LEAN_AND_MEAN
                        _WIN32_WINNT=0x0A00)
set(ZLIB_USE_STATIC_LIBS ON)
# Machine code: Debian has asmjit for its own processors only, so it is built of the source that cmake/asmjit_source.sh gets.
set(asmjit ${PROJECT_BINARY_DIR}/asmjit/src)
file(GLOB asmjit_sources ${asmjit}/asmjit/core/*.cpp ${asmjit}/asmjit/x86/*.cpp)
if(asmjit_sources)
  add_library(asmjit STATIC ${asmjit_sources})
  target_include_directories(asmjit SYSTEM PUBLIC ${asmjit})
  target_compile_definitions(asmjit PUBLIC ASMJIT_STATIC ASMJIT_NO_AARCH64 ASMJIT_NO_FOREIGN)
  add_library(asmjit::asmjit ALIAS asmjit)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/asmjit-config.cmake "")
endif()
# A program's manifest.
enable_language(RC)
# One file, without the DLLs of the compiler.
add_link_options(-static)

# Names of files are UTF-8 in every program and library.
add_library(ipos_utf8_letters STATIC ${PROJECT_SOURCE_DIR}/tools/windows/utf8_letters.cpp)
add_link_options(-Wl,--wrap=mbrtowc -Wl,--undefined=__wrap_mbrtowc)
link_libraries($<BUILD_INTERFACE:ipos_utf8_letters>)
