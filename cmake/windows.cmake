# What a build for Windows takes from where.
set(more_headers boost)  # the server of `ipos serve`
include(cmake/header_packages.cmake)
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY=1)

# Sizes of files have 64 bits; printf as the C standard says; names of Windows' own functions in UTF-16, and no macros min, max.
add_compile_definitions(_FILE_OFFSET_BITS=64 __USE_MINGW_ANSI_STDIO=1 UNICODE _UNICODE NOMINMAX WIN32_LEAN_AND_MEAN
                        _WIN32_WINNT=0x0A00)
set(ZLIB_USE_STATIC_LIBS ON)
# A program's manifest.
enable_language(RC)
# One file, without the DLLs of the compiler.
add_link_options(-static)
