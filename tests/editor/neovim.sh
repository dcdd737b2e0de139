#!/usr/bin/env bash
# Neovim without a screen, set up as docs/guide/editor.md says, opens a program: messages, hover, definition, rename and
# formatting come from `ipos lsp`.
# usage: neovim.sh IPOS PAGE
set -euo pipefail
command -v nvim >/dev/null || { echo "skipped: nvim is not installed"; exit 77; }
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/bin" "$work/home"
ln -s "$(realpath "$1")" "$work/bin/ipos"
sed -n '/^<!-- neovim -->$/,/^```$/{/^<!--/d;/^```/d;p}' "$2" >"$work/init.lua"
[ -s "$work/init.lua" ] || { echo "$2 has no lines for Neovim" >&2; exit 1; }
cat >"$work/SAW.IPC" <<'PROGRAM'
#include <constb.h>
long lTeeth; // of the saw
main()
{
    lTeeth = lTeeth + 1;
    lTooth = 2;
}
PROGRAM
cd "$work"
export HOME=$work/home XDG_CONFIG_HOME=$work/home XDG_DATA_HOME=$work/home XDG_STATE_HOME=$work/home PATH=$work/bin:$PATH
timeout 60 nvim --headless -u init.lua -i NONE SAW.IPC -c "luafile $here/neovim.lua" 2>&1 | tee out
grep -q '^6 requests, all answered' out
