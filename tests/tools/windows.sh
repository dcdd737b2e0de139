#!/usr/bin/env bash
# The program for Windows under wine does what the one for Linux does: the same outputs of the same examples, images equal
# to the byte, and a drive at a serial port. `./dev windows` builds it; ctest only tries what is built.
# usage: windows.sh IPOS.EXE IPOS      (IPOS: the program for Linux)
source "$(dirname "$0")/../windows/both.sh"
cd "$source_folder"

# The demo, text for text, and where two runs are equal to the last event.
same run examples/scom/scom.toml --for 1s --watch
same run examples/scom/scom.toml --for 1s --format json
for plant in examples/scom/scom.toml examples/hoist/hoist.toml examples/movilink-rs485/rs485.toml \
  examples/profibus/profibus.toml examples/canopen/canopen.toml examples/isync/isync.toml; do
  same run "$plant" --for 2s --trace-hash
done
same run examples/scom/scom.toml --for 1s --log - --trace "$work/trace.csv"

# Programs: the images of both are equal to the byte.
for program in examples/scom/*.IPC examples/tour/*.IPC; do
  "$linux" build "$program" -o "$work/linux.ipx"
  windows build "$program" -o "$work/windows.ipx" 2>"$work/err" || fail "build $program: $(cat "$work/err")"
  cmp "$work/linux.ipx" "$work/windows.ipx" || fail "build $program"
  same disasm "$work/linux.ipx"
  same run "$work/windows.ipx" --for 100ms
done
printf 'main()\n{\n    lTeeth = 1;\n}\n' >"$work/SÄGE.IPC"
(cd "$work" && same build SÄGE.IPC)
grep -q '^SÄGE.IPC:3:5: error: unknown name' "$work/windows.err" || fail "message of build: $(cat "$work/windows.err")"

# Tests, with the time they took left out.
windows test examples/scom examples/hoist examples/tour >"$work/out" || fail "test: $(cat "$work/out")"
grep -qE '^[0-9]+ tests?, [0-9]+ passed$' "$work/out" || fail "test: $(cat "$work/out")"
windows new "$work/line" >/dev/null && windows test "$work/line" >/dev/null || fail "new and test"
same explain E0201

# The memory of a unit in a file, and its parameters.
printf '[[station]]\nname = "saw"\nunit = "mdxb"\nnvram = "saw.nv"\n' >"$work/saw.toml"
windows param set "$work/saw.toml" P130=2.5s >/dev/null 2>"$work/err" || fail "param set: $(cat "$work/err")"
(cd "$work" && same param get saw.toml P130)
grep -q '2.500' "$work/windows" || fail "param get: $(cat "$work/windows")"

# Every verb is there; verbs.py in tests/windows compares what they do.
for verb in $("$linux" --help | sed -n '/^Begin:/,$s/^  \([a-z]\+\) .*/\1/p'); do
  windows "$verb" --help >"$work/out" 2>&1 || fail "$verb: $(cat "$work/out")"
done

# A drive at a serial port: one of the simulation at a pseudo-terminal, which wine calls COM7.
printf '[[bus]]\nname = "line"\nkind = "rs485"\nport = "pty:%s"\n[[station]]\nname = "saw"\nunit = "md60a"\nrs485 = "line"\n[station.parameters]\nP810 = 1\n' \
  "$work/tty" >"$work/port.toml"
"$linux" run "$work/port.toml" --realtime --for 600s >"$work/port.out" 2>&1 &
started=$!
for _ in $(seq 100); do [ -e "$work/tty" ] && break; sleep 0.1; done
[ -e "$work/tty" ] || fail "the drive does not come: $(cat "$work/port.out")"
wine reg add 'HKLM\Software\Wine\Ports' /v COM7 /d "$work/tty" /f >/dev/null
wineserver -k 2>/dev/null || true
wine cmd /c exit >/dev/null 2>&1  # reads the registry
windows param get --port COM7 --address 1 P130 >"$work/out" 2>"$work/err" || fail "serial: $(cat "$work/out" "$work/err")"
grep -q 'P130' "$work/out" || fail "serial: $(cat "$work/out")"
windows param set --port COM7 --address 1 P130=3s --volatile >"$work/out" 2>"$work/err" || fail "serial: $(cat "$work/err")"
windows param get --port COM7 --address 1 P130 2>/dev/null | grep -q '3.000' || fail "serial: P130 was not set"
kill $started
wait $started 2>/dev/null || true
started=
windows param get --port COM33 --address 1 P130 >"$work/out" 2>&1 && fail "a port that is not there"
grep -q 'COM33: there is no such device' "$work/out" || fail "COM33: $(cat "$work/out")"
windows param get --port can0 --address 1 P130 >"$work/out" 2>&1 && fail "SocketCAN"
grep -q 'can0: this build for Windows has no such port' "$work/out" || fail "can0: $(cat "$work/out")"

echo "$(stat -c %s "$exe") bytes; $count outputs as on Linux; parameters over COM7"
