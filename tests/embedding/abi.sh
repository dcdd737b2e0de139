#!/usr/bin/env bash
# The shared libraries show exactly the functions of abi/symbols.txt, and the structures of ipos.h and ipos_plant.h have
# the layout of abi/layout.txt (64 bits). A change of either is a change for everybody who is linked: a new major version, unless
# it only adds. `abi.sh SOURCE BUILD --update` writes both anew.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
need nm
abi=$source/tests/embedding/abi
for library in ipos ipos_compile ipos_plant; do
  nm -D --defined-only "$build/lib/lib$library.so" | awk -v lib=$library '$2 ~ /[TDBRVW]/ {print lib, $3}'
done | LC_ALL=C sort > "$work/symbols.txt"
"$CC" -I "$source/embed/include" -I "$build/include" "$abi/layout.c" -o "$work/layout"
"$CC" -std=c99 -Wall -Wextra -pedantic -Werror -I "$source/runtime/library/include" "$abi/plant_layout.c" -o "$work/plant_layout"
{ "$work/layout"; "$work/plant_layout"; } > "$work/layout.txt"
if [ "${3:-}" = --update ]; then
  cp "$work"/{symbols,layout}.txt "$abi"
  exit
fi
diff -u "$abi/symbols.txt" "$work/symbols.txt"
[ "$(getconf LONG_BIT)" = 64 ] || skip "layouts are those of 64 bits"
diff -u "$abi/layout.txt" "$work/layout.txt"
