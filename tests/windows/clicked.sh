#!/usr/bin/env bash
# Double clicks under wine: on ipos.exe, which opens the gallery, and, after the installer has run, on a plant. The browser of
# wine is a script that keeps the page it is led to; Chromium then shows it.
# usage: clicked.sh IPOS.EXE      (after clients.sh, which installs the packages that drive Chromium)
set -euo pipefail
skip() { echo "skipped: $*"; exit 77; }
[ -f "$1" ] || skip "there is no $1: ./dev windows builds it"
for tool in wine makensis Xvfb node /usr/bin/chromium; do command -v $tool >/dev/null || skip "$tool is not installed"; done
exe=$(realpath "$1") packages=$(dirname "$(realpath "$1")")/packages/web
[ -d "$packages/node_modules" ] || skip "there is no $packages/node_modules: clients.sh installs them"
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
export LC_ALL=C.UTF-8 WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml=' WINEPREFIX=$work/prefix
end() {
  wineserver -k 2>/dev/null || true
  kill "${screen:-}" 2>/dev/null || true
  rm -rf "$work"
}
trap end EXIT
fail() { echo "failed: $*" >&2; exit 1; }

# A console of its own, by which a double click is told from a command, needs a screen.
Xvfb -displayfd 3 -screen 0 1024x768x24 3>"$work/display" 2>/dev/null &
screen=$!
for _ in $(seq 100); do [ -s "$work/display" ] && break; sleep 0.1; done
[ -s "$work/display" ] || skip "Xvfb does not start"
DISPLAY=:$(cat "$work/display")
export DISPLAY
wine cmd /c exit >/dev/null 2>&1 || skip "wine does not start"

cat >"$work/browser" <<END
#!/bin/sh
cp "\$(printf %s "\$1" | sed 's#^file://##')" "$work/opening" && mv "$work/opening" "$work/opened"
END
chmod +x "$work/browser"
wine reg add 'HKCU\Software\Wine\WineBrowser' /v Browsers /d "$work/browser" /f >/dev/null

wine reg add 'HKCR\.html' /ve /d htmlfile /f >/dev/null  # else done by wine's mshtml, which is not here

# clicked FILE ROLE NAME: a double click on the file opens a page that has an element of that role and name.
clicked() {
  rm -f "$work/opened"
  wine start /unix "$1" >/dev/null 2>&1
  for _ in $(seq 600); do [ -f "$work/opened" ] && break; sleep 0.1; done
  [ -f "$work/opened" ] || fail "a double click on $1 opens no browser"
  node tests/windows/clicked.mjs "$packages" "$(sed -n 's/.*url=\([^"]*\)".*/\1/p' "$work/opened")" "$2" "$3" || fail "$1"
  echo "a double click on $(basename "$1") opens a page with the $2 $3"
  wineserver -k
}
clicked "$exe" region Gallery

python3 packaging/windows/setup.py "$exe" "$work/made" >/dev/null
wine "$work"/made/*-setup.exe /S >/dev/null 2>&1 || fail "the installer"
wineserver -w
# Windows looks for what opens a file in the user's classes before the machine's. wine 8.0 looks in the machine's alone.
wine reg export 'HKCU\Software\Classes' "$work/classes.reg" /y >/dev/null
iconv -f UTF-16 -t UTF-8 "$work/classes.reg" | sed 's#HKEY_CURRENT_USER#HKEY_LOCAL_MACHINE#' >"$work/machine.reg"
wine reg import "$work/machine.reg" >/dev/null 2>&1 || fail "the classes of the installer"
mkdir "$work/Hebezeug für Kisten"
cp examples/hoist/HOIST.IPC examples/hoist/hoist.toml "$work/Hebezeug für Kisten"
clicked "$work/Hebezeug für Kisten/hoist.toml" switch "hoist DI10"
