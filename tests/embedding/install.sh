#!/usr/bin/env bash
# cmake --install into an empty folder that is then moved; programs are built against it with find_package and with
# pkg-config.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
. "$(dirname "$0")/hello_project.sh"
cmake --install "$build" --prefix "$work/first" >/dev/null
mv "$work/first" "$work/prefix"
lib=$(dirname "$(find "$work/prefix" -name libipos.a)")
[ -x "$work/prefix/bin/ipos" ] || fail "the tool is not installed"

write_project "$work/project" "find_package(ipos 0.1 REQUIRED)" compile
cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
cmake --build "$work/project/build" >/dev/null
"$work/project/build/version"
expect "$("$work/project/build/hello" | wc -l)" 3

need pkg-config
unset LD_LIBRARY_PATH
export PKG_CONFIG_PATH=$lib/pkgconfig
cd "$work/project"
"$CC" -std=c99 hello.c -o hello_pc $(pkg-config --cflags --libs ipos_compile)
expect "$(./hello_pc | wc -l)" 3
# The static library needs no C++ library.
"$CC" -std=c99 version.c -o version_pc $(pkg-config --cflags ipos) "$lib/libipos.a"
./version_pc
"$CXX" -std=c++20 -fsyntax-only -x c++ $(pkg-config --cflags ipos) "$work/prefix/include/ipos.hpp"
