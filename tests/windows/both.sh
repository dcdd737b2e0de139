# What tests that start ipos.exe under wine beside the program for Linux have in common; they source it with both programs as
# their words. They get $exe, $linux, a folder $work that goes with them, and functions that compare and count.
set -euo pipefail
skip() { echo "skipped: $*"; exit 77; }
[ -f "$1" ] || skip "there is no $1: ./dev windows builds it"
command -v wine >/dev/null || skip "wine is not installed"
exe=$(realpath "$1") linux=$(realpath "$2")
source_folder=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
work=$(mktemp -d)
started=
export LC_ALL=C.UTF-8 WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml=' WINEPREFIX=$work/prefix
mkdir -p "$WINEPREFIX"
trap 'kill $started 2>/dev/null || true; wineserver -k 2>/dev/null || true; rm -rf "$work"' EXIT
wine cmd /c exit >/dev/null 2>&1 || skip "wine does not start"

count=0
fail() { echo "failed: $*" >&2; exit 1; }
windows() { wine "$exe" "$@"; }
# Both give the same exit code, and the same on standard output.
same() {
  local code=0 windows_code=0
  "$linux" "$@" >"$work/linux" 2>"$work/linux.err" || code=$?
  windows "$@" >"$work/windows" 2>"$work/windows.err" || windows_code=$?
  [ $code = $windows_code ] || fail "$*: exit code $windows_code in place of $code: $(cat "$work/windows.err")"
  cmp -s "$work/linux" "$work/windows" || { diff "$work/linux" "$work/windows" | head -20; fail "$*"; }
  count=$((count + 1))
}
