# What a build for browsers (preset `web`, Debian's emscripten) takes from where. docs/guide/browser.md
include(cmake/header_packages.cmake)
# {fmt} and toml++ are compiled once (tools/static), as many sources use them.
add_library(ipos_web_fmt STATIC tools/static/fmt.cpp)
add_library(ipos_web_toml STATIC tools/static/toml.cpp)
target_compile_options(ipos_web_fmt PRIVATE -Os)
target_compile_options(ipos_web_toml PRIVATE -Os)
target_link_libraries(fmt::fmt INTERFACE ipos_web_fmt)
target_link_libraries(tomlplusplus::tomlplusplus INTERFACE ipos_web_toml)
target_compile_definitions(tomlplusplus::tomlplusplus INTERFACE TOML_HEADER_ONLY=0)
target_compile_definitions(ipos_web_toml PRIVATE TOML_HEADER_ONLY=0)

# What Debian's libc++ for emscripten lacks of C++20 stands in front of it.
include_directories(BEFORE SYSTEM ${PROJECT_SOURCE_DIR}/web/wasm/library)

# Exceptions of WebAssembly itself: those that go through JavaScript cost every call that has something to tidy up.
add_compile_options(-fwasm-exceptions)
add_link_options(-fwasm-exceptions)

# No threads, and no zlib in Debian for this target.
file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/threads-config.cmake "")
file(WRITE ${CMAKE_FIND_PACKAGE_REDIRECTS_DIR}/zlib-config.cmake "")
add_library(Threads::Threads INTERFACE IMPORTED GLOBAL)
add_library(ZLIB::ZLIB INTERFACE IMPORTED GLOBAL)

# Only this build has a size_t of 32 bits, and most who write sources do not build it: what is cut to it is told, and is no error.
add_compile_options(-Wno-error=shorten-64-to-32 -Wno-error=c++11-narrowing)
