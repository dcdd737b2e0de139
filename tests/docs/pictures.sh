#!/usr/bin/env bash
# The pictures on the pages are what the commands print or plot, and pictures of screens are small.
#   tests/docs/pictures.sh IPOS           compares
#   tests/docs/pictures.sh IPOS --renew   draws them anew
set -euo pipefail
ipos=$(realpath "$1")
cd "$(dirname "$0")/../.."
status=0

# compare FILE COMMAND DRAWN
compare() {
  local file=docs/images/$1 command=$2 drawn=$3
  if [ "${renew:-}" ]; then
    printf '%s\n' "$drawn" >"$file"
  elif [ "$drawn" != "$(cat "$file")" ]; then
    echo "$file is not what 'ipos $command' prints; tests/docs/pictures.sh IPOS --renew draws it anew" >&2
    status=1
  fi
}

# terminal FILE COMMAND: the terminal after it. It may fail, as tests of broken programs do.
terminal() {
  compare "$1" "$2" "$({ "$ipos" $2 2>&1 || true; } | docs/images/terminal.py "ipos $2")"
}

# plot FILE COMMAND: what it writes to standard output.
plot() {
  compare "$1" "$2" "$("$ipos" $2 2>/dev/null)"
}

[ "${2:-}" = --renew ] && renew=1
terminal test-report.svg "test tests/tools/testing/broken/feeder.test.toml"
plot isync.svg "run examples/isync/isync.toml --for 4s --plot - --signals master.speed,slave.speed,master.position,slave.position"
plot nameplate.svg "run examples/nameplate/nameplate.toml --for 4s --plot - --signals ideal.speed,real.speed,ideal.current,real.current,real.AO1,real.DB00,ideal.shaft_angle,real.shaft_angle"
for picture in docs/images/*.png; do
  [ "$(stat -c %s "$picture")" -le 65536 ] || { echo "$picture is larger than 64 KiB; docs/images/smaller.sh makes it smaller" >&2; status=1; }
done
exit $status
