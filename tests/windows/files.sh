#!/usr/bin/env bash
# Files under wine: names in any letters, long, with drives and backslashes; CR LF; a file that somebody holds when it is
# replaced; the memory of a unit when the program is killed. Names are looked at from Linux, where a letter taken for two
# would be seen.
# usage: files.sh IPOS.EXE IPOS      (IPOS: the program for Linux)
source "$(dirname "$0")/both.sh"
command -v x86_64-w64-mingw32-gcc >/dev/null || skip "the cross compiler is not installed"
holds() { count=$((count + 1)); "$@" || fail "$*"; }

# Names: two bytes, three bytes, and beyond 16 bits.
folder="$work/Größe Ω漢 𝄞"
mkdir -p "$folder/Köpfe"
cd "$folder"
printf '#define TEETH 12\n' >Köpfe/Maße.H
cat >SÄGE.IPC <<'P'
#include <const.h>
#include "Köpfe\Maße.H"
long lTeeth;
main()
{
    while (1) { lTeeth = lTeeth + TEETH; _Wait(10); }
}
P
plant() { printf '[[station]]\nname = "saw"\nunit = "mdxb"\nprogram = %s\nnvram = "Gedächtnis 𝄞.nv"\n' "$1"; }
plant '"SÄGE.IPC"' >Säge.toml
same run Säge.toml --for 1s --trace-hash
holds [ -f "Gedächtnis 𝄞.nv" ]
same run SÄGE.IPC --for 100ms --format json
windows run Säge.toml --for 100ms --trace Spur_ä.csv >/dev/null 2>"$work/err" || fail "trace: $(cat "$work/err")"
holds [ -f Spur_ä.csv ]
windows build SÄGE.IPC -o Bild_Ω.ipx >/dev/null 2>"$work/err" || fail "build: $(cat "$work/err")"
holds [ -f Bild_Ω.ipx ]
"$linux" build SÄGE.IPC -o linux.ipx >/dev/null 2>&1
holds cmp linux.ipx Bild_Ω.ipx
windows new "Maß𝄞" >/dev/null 2>"$work/err" || fail "new: $(cat "$work/err")"
holds [ -d "Maß𝄞" ]
windows test "Maß𝄞" >/dev/null 2>"$work/err" || fail "test: $(cat "$work/err")"
count=$((count + 1))
same test "Maß𝄞" --list
plant '"fehlt_ä.IPC"' >fehlt.toml
same run fehlt.toml --for 1s
holds grep -q 'fehlt_ä.IPC' "$work/windows.err"
[ -z "$(find "$folder" -name '*Ã*' -o -name '*�*')" ] || fail "a letter became two: $(find "$folder")"

# Backslashes and drives, in plants and on the command line.
mkdir unter
cp -r SÄGE.IPC Köpfe unter/
plant "'unter\\SÄGE.IPC'" >back.toml
windows run back.toml --for 1s --trace-hash >"$work/out" 2>"$work/err" || fail "backslash: $(cat "$work/err")"
plant "'Z:${folder//\//\\}\\SÄGE.IPC'" >drive.toml
windows run drive.toml --for 1s --trace-hash >"$work/out2" 2>"$work/err" || fail "drive: $(cat "$work/err")"
windows run "Z:${folder//\//\\}\\Säge.toml" --for 1s --trace-hash >"$work/out3" 2>"$work/err" || fail "drive: $(cat "$work/err")"
"$linux" run Säge.toml --for 1s --trace-hash >"$work/out4"
for n in "" 2 3; do holds [ "$(tail -1 "$work/out$n")" = "$(tail -1 "$work/out4")" ]; done

# Longer than 260 letters.
long=$folder
for n in 1 2 3 4 5 6; do long=$long/$(printf 'ordner_%.0s' 1 2 3 4 5 6 7); done
mkdir -p "$long"
cp -r SÄGE.IPC Köpfe Säge.toml "$long/"
same run "$long/Säge.toml" --for 1s --trace-hash

# CR LF in everything.
for example in scom hoist; do
  cp -r "$source_folder/examples/$example" "$work/$example"
  find "$work/$example" -type f -exec sed -i 's/$/\r/' {} +
  "$linux" run "$source_folder/examples/$example/$example.toml" --for 8s --trace-hash >"$work/lf"
  windows run "$work/$example/$example.toml" --for 8s --trace-hash >"$work/crlf" 2>"$work/err" || fail "CR LF: $(cat "$work/err")"
  holds cmp "$work/lf" "$work/crlf"
  windows test "$work/$example" >/dev/null 2>"$work/err" || fail "CR LF: $(cat "$work/err")"
done

# A file that is held, as a virus scanner does, for a moment, and for long.
cat >"$work/holder.c" <<'P'
#include <windows.h>
#include <stdlib.h>
int wmain(int count, wchar_t** words) {
  HANDLE file = CreateFileW(words[1], GENERIC_READ, FILE_SHARE_READ, 0, OPEN_EXISTING, 0, 0);
  if (count < 4 || file == INVALID_HANDLE_VALUE) return 1;
  CloseHandle(CreateFileW(words[3], GENERIC_WRITE, 0, 0, CREATE_ALWAYS, 0, 0));  /* says that it holds */
  Sleep(_wtoi(words[2]));
  return 0;
}
P
x86_64-w64-mingw32-gcc -municode -O1 -o "$work/holder.exe" "$work/holder.c"
held() {  # MILLISECONDS: while FILE is held so long, it is formatted
  printf 'main() { long   x; }\n' >held.IPC
  rm -f held.mark
  wine "$work/holder.exe" held.IPC "$1" held.mark &
  for _ in $(seq 200); do [ -e held.mark ] && break; sleep 0.05; done
  [ -e held.mark ] || fail "nobody holds the file"
  local code=0
  windows fmt held.IPC >"$work/out" 2>&1 || code=$?
  wait $!
  return $code
}
held 300 || fail "a file that is held for a moment: $(cat "$work/out")"
holds [ "$(head -1 held.IPC)" = "main()" ]
! held 20000 || fail "a file that is held for long"
holds grep -q 'held.IPC: ' "$work/out"
holds [ "$(cat held.IPC)" = "main() { long   x; }" ]
holds [ -z "$(find . -maxdepth 1 -name '.held*')" ]

# The memory of a unit is the old one or the new one when the program is killed.
windows param set Säge.toml P130=1s >/dev/null 2>"$work/err" || fail "param set: $(cat "$work/err")"
killed=0
for n in $(seq 30); do
  wine "$exe" param set Säge.toml P130=$((n + 1))s >/dev/null 2>&1 &
  sleep "0.$(printf %03d $((RANDOM % 400)))"
  pkill -9 -P $$ -f 'param set' 2>/dev/null && killed=$((killed + 1)) || true
  wait $! 2>/dev/null || true
  windows param get Säge.toml P130 >"$work/out" 2>"$work/err" || fail "after a kill: $(cat "$work/err")"
  grep -qE ' [0-9]+\.000' "$work/out" || fail "after a kill: $(cat "$work/out")"
done
count=$((count + 30))

echo "$count checks of names and files; killed $killed of 30 times while the memory was written"
