#!/usr/bin/env bash
# What drives ipos from outside meets ipos.exe: journeys through its page in Chromium, and the packages that VS Code speaks to a
# language server and a debug adapter with. They are the tests of the program for Linux with another program.
# usage: clients.sh IPOS.EXE web|editor TEST...     (77: something is missing)
set -euo pipefail
skip() { echo "skipped: $*"; exit 77; }
[ -f "$1" ] || skip "there is no $1: ./dev windows builds it"
command -v wine >/dev/null || skip "wine is not installed"
command -v npm >/dev/null || skip "there is no node and npm here"
kind=$2
command -v x86_64-w64-mingw32-gcc >/dev/null || skip "the cross compiler is not installed"
[ "$kind" != web ] || [ -x /usr/bin/chromium ] || skip "/usr/bin/chromium is not installed"
export IPOS_EXE=$(realpath "$1")
here=$(cd "$(dirname "$0")" && pwd) project=$(cd "$(dirname "$0")/../.." && pwd)
export WINEPREFIX=${WINEPREFIX:-$(dirname "$IPOS_EXE")/wine} IPOS_EXAMPLES=$project/examples IPOS_DRIVE=Z
mkdir -p "$WINEPREFIX"
"$here/ipos.sh" --version >/dev/null 2>&1 || skip "wine does not start"

# The packages in a copy; no script of a package is run.
source=$project/$([ "$kind" = web ] && echo web || echo tests/editor)
packages=$(dirname "$IPOS_EXE")/packages/$kind
mkdir -p "$packages"
for entry in "$source"/*; do
  case $(basename "$entry") in node_modules | out) continue ;; esac
  rm -rf "${packages:?}/$(basename "$entry")"
  cp -r "$entry" "$packages"
done
cd "$packages"
npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1 >npm.log 2>&1 || skip "npm: $(tail -1 npm.log)"
shift 2
IPOS_PROGRAM=$here/ipos.sh exec node --test --test-reporter=tap "$@"
