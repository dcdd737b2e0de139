#!/usr/bin/env bash
# ipos.exe under wine in the place of ipos, for tests that start a program: what goes in and out is the same, and so is Ctrl-C.
# usage: IPOS_EXE=.../ipos.exe WINEPREFIX=... ipos.sh WORD...
export WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml='
unset DISPLAY
# Where tests want the state of a user it is there, too.
[ -z "${XDG_STATE_HOME:-}" ] || export XDG_STATE_HOME=Z:${XDG_STATE_HOME//\//\\}
# Servers of editors look into the pipe of their input.
case ${1:-} in dap | lsp)
  pipes=$(dirname "$IPOS_EXE")/pipes.exe source=$(dirname "$0")/pipes.c
  [ "$pipes" -nt "$source" ] || x86_64-w64-mingw32-gcc -O1 -Wall -Wextra -Werror -o "$pipes" "$source" || exit
  exec wine "$pipes" "Z:${IPOS_EXE//\//\\}" "$@" ;;
esac
exec wine "$IPOS_EXE" "$@"
