#!/usr/bin/env bash
# Runs the demo and three plants under valgrind's memcheck: no use of memory that was never written, none out of
# bounds, none lost.
#   tests/examples/memcheck.sh build/dev/tools/ipos
set -euo pipefail
[ $# -eq 1 ] || { sed -n '4s/^# *//p' "$0"; exit 64; }
command -v valgrind >/dev/null || { echo "skipped: valgrind is not installed"; exit 77; }
ipos=$1
examples=$(cd "$(dirname "$0")/../../examples" && pwd)
for plant in scom/scom.toml two-tasks/two-tasks.toml table-positioning/table-positioning.toml movilink/movilink.toml; do
  echo "$plant"
  valgrind --quiet --error-exitcode=99 --leak-check=full --errors-for-leak-kinds=definite \
    "$ipos" run "$examples/$plant" --for 2s --engine fast >/dev/null || [ $? -ne 99 ]
done
