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
# The plant as a library needs its own shared library alone.
cat >plant.c <<'C'
#include <ipos_plant.h>
#include <stdio.h>
int main(void) {
  ipos_plant_source source = {0};
  ipos_plant* plant;
  source.text = "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n";
  if (ipos_plant_open(&source, &plant) != IPOS_PLANT_OK || ipos_plant_run(plant, 1000000) != IPOS_PLANT_OK) return 1;
  puts(ipos_plant_status_text(ipos_plant_close(plant)));
}
C
"$CC" -std=c99 -pedantic -Wall -Wextra -Werror plant.c -o plant $(pkg-config --cflags --libs ipos_plant)
expect "$(./plant)" done
