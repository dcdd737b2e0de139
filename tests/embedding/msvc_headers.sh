#!/usr/bin/env bash
# Whether Microsoft's compiler would take the public headers, as far as clang tells that imitates it (-fms-compatibility): the
# headers in C and C++, and the layout of their structures, which is that of abi/layout.txt. Microsoft's own headers are not
# needed; msvc/ stands in for what ipos.hpp includes of C++.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
need clang
here=$source/tests/embedding
includes=(-I "$source/runtime/library/include" -I "$source/embed/include" -I "$build/include")
microsoft=(--target=x86_64-pc-windows-msvc -fsyntax-only -fms-compatibility -fms-extensions -fms-compatibility-version=19.30
           -ffreestanding -Wall -Wextra -Wpedantic -Werror "${includes[@]}")
{
  printf '#include <%s>\n' ipos_plant.h ipos.h ipos_compile.h stddef.h
  # Each line of layout.txt is what a compiler has to agree to.
  sed -E 's/^([a-z_]+)\.([a-z_]+) ([0-9]+)$/typedef char at_\1_\2[offsetof(\1, \2) == \3 ? 1 : -1];/
          s/^([a-z_]+) ([0-9]+)$/typedef char size_\1[sizeof(\1) == \2 ? 1 : -1];/' "$here/abi/layout.txt"
} >"$work/headers.c"
[ "$(grep -c typedef "$work/headers.c")" = "$(grep -c . "$here/abi/layout.txt")" ] || fail "layout.txt has lines of another form"
for standard in c99 c11 c17; do clang "${microsoft[@]}" -std=$standard "$work/headers.c"; done
for standard in c++14 c++17 c++20; do clang "${microsoft[@]}" -x c++ -std=$standard "$work/headers.c"; done
echo '#include <ipos.hpp>' >"$work/headers.cpp"
clang "${microsoft[@]}" -x c++ -std=c++20 -I "$here/msvc" "$work/headers.cpp"
