# Toolchain file: WebAssembly with Debian's emscripten. The preset `web` uses it.
set(CMAKE_CXX_COMPILER em++)
include(/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
# Its optimiser of JavaScript is made of Debian's Node modules, which another Node does not look for: NODE_PATH of the preset.
