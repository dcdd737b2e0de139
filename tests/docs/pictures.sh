#!/usr/bin/env bash
# The pictures of terminals on the pages are what the commands print.
#   tests/docs/pictures.sh IPOS           compares
#   tests/docs/pictures.sh IPOS --renew   draws them anew
set -euo pipefail
ipos=$(realpath "$1")
cd "$(dirname "$0")/../.."
status=0

picture() {
  local file=docs/images/$1 command=$2 drawn
  # The commands may fail, as tests of broken programs do.
  drawn=$( { "$ipos" $command 2>&1 || true; } | docs/images/terminal.py "ipos $command")
  if [ "${renew:-}" ]; then
    printf '%s\n' "$drawn" >"$file"
  elif [ "$drawn" != "$(cat "$file")" ]; then
    echo "$file is not what 'ipos $command' prints; tests/docs/pictures.sh IPOS --renew draws it anew" >&2
    status=1
  fi
}

[ "${2:-}" = --renew ] && renew=1
picture test-report.svg "test tests/tools/testing/broken/feeder.test.toml"
exit $status
