#!/usr/bin/env bash
# The static binary in a root file system with nothing else in it: no library, no shell, no /proc, no /dev.
# usage: bare_root.sh BINARY
set -euo pipefail
[ "$(id -u)" = 0 ] || { echo "skipped: chroot needs root"; exit 77; }
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
cp "$1" "$root/ipos"
fail() { echo "failed: $1" >&2; exit 1; }
chroot "$root" /ipos --version | grep -q '^ipos ' || fail "--version"
chroot "$root" /ipos new /line >"$root/out" || fail "new"
chroot "$root" /ipos test /line >"$root/out" || fail "test: $(cat "$root/out")"
grep -q '^1 test, 1 passed$' "$root/out" || fail "test: $(cat "$root/out")"
for engine in reference fast native; do
  chroot "$root" /ipos run /line/line.toml --for 3s --watch=lTarget --engine "$engine" >"$root/out.$engine" ||
    fail "run with the engine $engine"
done
cmp "$root/out.reference" "$root/out.fast" || fail "engines differ"
cmp "$root/out.reference" "$root/out.native" || fail "engines differ"
chroot "$root" /ipos explain E0201 | grep -q . || fail "explain"
echo "$(stat -c %s "$1") bytes, works alone"
