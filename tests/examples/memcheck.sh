#!/usr/bin/env bash
# Runs the tests of all examples, and the demo in every engine, under valgrind's memcheck: all pass, and no memory is
# used that was never written, none out of bounds, none lost.
#   tests/examples/memcheck.sh build/dev/tools/ipos
set -euo pipefail
[ $# -eq 1 ] || { sed -n '4s/^# *//p' "$0"; exit 64; }
command -v valgrind >/dev/null || { echo "skipped: valgrind is not installed"; exit 77; }
ipos=$(realpath "$1")
examples=$(cd "$(dirname "$0")/../../examples" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" # where `ipos test` notes what failed

checked() {
  valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite "$ipos" "$@"
}

checked test -j1 "$examples"
for engine in '--engine reference' '--engine fast' ''; do # without a name: the fastest of the build
  # shellcheck disable=SC2086
  checked run "$examples/scom/scom.toml" --for 2s --watch $engine
done
