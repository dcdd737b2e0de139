# What a build for Windows takes from where. Debian has {fmt}, CLI11, nlohmann-json, toml++ and tl::expected for Linux only,
# but all of them work out of their headers alone. Those headers, and no others of /usr/include, are linked into a folder of
# the build tree.
set(headers ${PROJECT_BINARY_DIR}/headers)
foreach(header fmt CLI nlohmann toml++ tl linux/can/error.h)  # the last: numbers of CAN errors, which a record of a line names
  find_path(found_${header} ${header} PATHS /usr/include NO_DEFAULT_PATH NO_CMAKE_FIND_ROOT_PATH NO_CACHE REQUIRED)
  get_filename_component(folder ${headers}/${header} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  file(CREATE_LINK ${found_${header}}/${header} ${headers}/${header} SYMBOLIC)
endforeach()

# find_package() takes these in place of the packages.
foreach(row fmt=fmt::fmt CLI11=CLI11::CLI11 nlohmann_json=nlohmann_json::nlohmann_json tomlplusplus=tomlplusplus::tomlplusplus)
  string(REPLACE "=" ";" row ${row})
  list(POP_FRONT row package)
  add_library(${row} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${row} INTERFACE ${headers})
  string(TOLOWER ${package} name)
  file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/${name}-config.cmake "")
endforeach()
target_compile_definitions(fmt::fmt INTERFACE FMT_HEADER_ONLY=1)

include_directories(SYSTEM ${headers})
# Sizes of files have 64 bits; printf as the C standard says; names of Windows' own functions in UTF-16, and no macros min, max.
add_compile_definitions(_FILE_OFFSET_BITS=64 __USE_MINGW_ANSI_STDIO=1 UNICODE _UNICODE NOMINMAX WIN32_LEAN_AND_MEAN
                        _WIN32_WINNT=0x0A00)
set(ZLIB_USE_STATIC_LIBS ON)
# A program's manifest.
enable_language(RC)
# One file, without the DLLs of the compiler.
add_link_options(-static)
