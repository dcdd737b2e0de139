#!/usr/bin/env bash
# All that is asked of ipos.exe under wine, with what was skipped and why.
# usage: all.sh IPOS.EXE IPOS      (IPOS: the program for Linux)
set -uo pipefail
exe=$(realpath "$1") linux=$(realpath "$2")
cd "$(dirname "$0")"
status=0
try() {
  echo "== $*"
  "$@"
  local code=$?
  [ $code = 0 ] || [ $code = 77 ] || { echo "failed: $*"; status=1; }
}
try ../tools/windows.sh "$exe" "$linux"
try ./ports.sh "$exe" "$linux"
try ./files.sh "$exe" "$linux"
try python3 ../packaging/setup_test.py "$exe"
try python3 verbs.py "$exe" "$linux"
try ./clients.sh "$exe" editor lsp.test.mjs dap.test.mjs
try ./clients.sh "$exe" web test/timeline.test.mjs test/edit.test.mjs test/gallery.test.mjs test/keep.test.mjs
try ./clicked.sh "$exe"
exit $status
