#!/usr/bin/env bash
# The C program of the README is compiled and run as printed there, and prints what the README says; it is also
# examples/embedding/c/hello.c.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
awk '/^```c$/ {on = 1; next} /^```$/ {on = 0} on' "$source/README.md" > "$work/hello.c"
[ -s "$work/hello.c" ] || fail "the README has no C program"
cmp "$work/hello.c" "$source/examples/embedding/c/hello.c"
awk '/^\$ .*hello$/ {on = 1; next} /^```$/ {on = 0} on' "$source/README.md" > "$work/expected"
cmake --install "$build" --prefix "$work/prefix" >/dev/null
cd "$work"
export PKG_CONFIG_PATH=$(dirname "$(find "$work/prefix" -name ipos.pc)")
command=$(sed -n 's/^\$ \(cc .*hello\.c.*\)$/\1/p' "$source/README.md")
[ -n "$command" ] || fail "the README does not say how to compile its program"
need pkg-config
eval "$command -Wall -Wextra -Werror"
unset LD_LIBRARY_PATH
expect "$(./hello)" "$(cat expected)"
