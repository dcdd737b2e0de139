#!/usr/bin/env bash
# The tutorial word for word in an empty Debian 12, with the static binary and nothing else installed; prints the time.
# The system comes from Debian's archive by debootstrap, in minutes, so `./dev check tutorial` runs this and ctest does not.
# usage: empty_debian.sh STATIC_IPOS TUTORIAL [ROOT]      (ROOT: such a system, made before; it is left as it was)
set -euo pipefail
skip() { echo "skipped: $*"; exit 77; }
[ "$(id -u)" = 0 ] || skip "chroot needs root"
[ -x "$1" ] || skip "there is no $1: ./dev static makes it"
root=${3:-}
if [ -z "$root" ]; then
  command -v debootstrap >/dev/null || skip "debootstrap is not installed"
  root=$(mktemp -d)
  trap 'rm -rf "$root"' EXIT
  debootstrap --variant=minbase bookworm "$root" >"$root.log" 2>&1 ||
    { tail -n 3 "$root.log"; rm -f "$root.log"; skip "no Debian could be made"; }
  rm -f "$root.log"
else
  trap 'rm -f "$root/usr/local/bin/ipos"' EXIT
fi
echo "Debian $(cat "$root/etc/debian_version"), $(ls "$root"/var/lib/dpkg/info/*.list | wc -l) packages"
for library in fmt toml edit asmjit; do
  compgen -G "$root/usr/lib/*/lib$library*" >/dev/null && { echo "lib$library is there, it is not empty"; exit 1; }
done
began=$EPOCHREALTIME
python3 "$(dirname "$0")/follow.py" "$2" "$1" --root "$root"
echo "followed in $(awk "BEGIN { print $EPOCHREALTIME - $began }") s"
