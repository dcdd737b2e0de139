#!/usr/bin/env bash
# Real ports of the program for Windows under wine. CAN: makers' libraries, for which stand-ins on a shared bus step in
# (tests/runtime/os_port/stand_in); two stations at an adapter answer a master at another one, also one of Linux. Serial: COM
# ports that wine links to pseudo-terminals, with our masters for MOVILINK and PROFIBUS at the other end.
# usage: ports.sh IPOS.EXE IPOS [STAND_INS]      (IPOS: the program for Linux; STAND_INS: folder of those for Linux)
set -euo pipefail
skip() { echo "skipped: $*"; exit 77; }
[ -f "$1" ] || skip "there is no $1: ./dev windows builds it"
command -v wine >/dev/null || skip "wine is not installed"
compiler=x86_64-w64-mingw32-g++-posix
command -v $compiler >/dev/null || skip "there is no $compiler"
exe=$(realpath "$1") linux=$(realpath "$2") stand_ins=${3:-}
cd "$(dirname "$0")/../.."
work=$(mktemp -d)
export LC_ALL=C.UTF-8 WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml=' WINEPREFIX=$(dirname "$exe")/wine-ports
unset DISPLAY
mkdir -p "$WINEPREFIX"
started=()
end() {
  for process in "${started[@]}"; do kill "$process" 2>/dev/null || true; done
  wineserver -k 2>/dev/null || true
  rm -rf "$work"
}
trap end EXIT
wine cmd /c exit >/dev/null 2>&1 || skip "wine does not start"
fail() { echo "failed: $*" >&2; exit 1; }
windows() { wine "$exe" "$@"; }
# Until a file has the text, a minute at most.
wait_for() {
  for _ in $(seq 600); do grep -qF "$2" "$1" 2>/dev/null && return 0; sleep 0.1; done
  fail "'$2' does not come: $(cat "$1")"
}

# --- adapters

mkdir "$work/dll"
for row in pcan=PCANBasic vector=vxlapi64 kvaser=canlib32 ixxat=vcinpl; do
  $compiler -std=c++20 -O1 -shared -static -I. -o "$work/dll/${row#*=}.dll" tests/runtime/os_port/stand_in/${row%=*}.cpp
done
cp examples/scom/SCOM*.IPC "$work"
plant_at() { sed "s|kind = \"can\"|&\nport = \"$1\"|" examples/scom/scom.toml >"$work/scom.toml"; }

# Before the libraries are there.
plant_at pcan:USB1
windows run "$work/scom.toml" --realtime --for 10ms >"$work/out" 2>&1 && fail "a library that is not there"
grep -q "pcan:USB1: the library of the adapter's maker is not here: PCANBasic.dll is not found; it comes with PCAN-Basic" "$work/out" ||
  fail "the missing library: $(cat "$work/out")"

export WINEPATH="Z:${work//\//\\}\\dll" IPOS_STAND_IN_BUS=$work/bus
# Bits of the switches in the shared bus (BusSwitches of shared_bus.hpp): word and value.
switch() { printf "$2" | dd of="$work/bus" bs=1 seek=$((4 * $1)) conv=notrunc status=none; }

adapter=0
for row in pcan:USB1=pcan:USB2 vector:0=vector:1 kvaser:0=kvaser:1 ixxat:0=ixxat:0.1; do
  port=${row%=*} other=${row#*=} run=$work/run$adapter
  plant_at "$port"
  rm -f "$work/bus"
  wine "$exe" run "$work/scom.toml" --realtime --for 600s >"$run" 2>&1 &
  started+=($!)
  wait_for "$run" "is joined to $port"
  for address in 0 1; do
    windows param get --port "$other" --address $address P130 >"$work/out" 2>&1 || fail "$other: $(cat "$work/out" "$run")"
    grep -q P130 "$work/out" || fail "$other: $(cat "$work/out")"
  done
  # The program for Linux, with the same library for Linux, on the same bus.
  [ -z "$stand_ins" ] || LD_LIBRARY_PATH=$stand_ins "$linux" param get --port kvaser:3 --address 0 P130 >"$work/out" 2>&1 || fail "Linux at $port: $(cat "$work/out")"
  # Byte 0 of a switch has the channels of PCAN-Basic, byte 1 those of Vector, and so on.
  bit() { for _ in $(seq $adapter); do printf '\\0'; done; printf '\\1'; }
  switch 4 "$(bit)"  # error warning
  wait_for "$run" "controller (receive errors: 96 or more"
  switch 4 '\0\0\0\0'
  switch 2 "$(bit)"  # bus-off
  wait_for "$run" "bus-off: the controller takes no part until it is restarted"
  wait_for "$run" "the controller has been restarted"
  windows param get --port "$other" --address 1 P130 >"$work/out" 2>&1 || fail "$other after bus-off: $(cat "$work/out" "$run")"
  switch 0 "$(bit)"  # pulled out
  code=0
  wait "${started[-1]}" || code=$?
  [ $code = 74 ] || fail "$port pulled out: exit code $code: $(cat "$run")"
  grep -q "$port: the device has gone" "$run" || fail "$port pulled out: $(cat "$run")"
  adapter=$((adapter + 1))
done
rm -f "$work/bus"
windows param get --port pcan:USB9 --address 1 P130 >"$work/out" 2>&1 && fail "pcan:USB9"
grep -q 'pcan:USB9: there is no such channel: there is USB1, USB2, USB3, USB4' "$work/out" || fail "pcan:USB9: $(cat "$work/out")"

# --- COM ports

# Two pseudo-terminals that are one line, as links one and two.
/usr/bin/python3 -u - "$work/one" "$work/two" <<'PAIR' >"$work/pair" 2>&1 &
import os, select, sys, tty
ends, devices = [], []
for link in sys.argv[1:]:
    end, device = os.openpty()
    tty.setraw(device)
    os.symlink(os.ttyname(device), link)
    ends.append(end)
    devices.append(device)
print("joined")
while True:
    for end in select.select(ends, [], [])[0]:
        os.write(ends[1 - ends.index(end)], os.read(end, 4096))
PAIR
started+=($!)
wait_for "$work/pair" joined
for com in COM3 COM12; do
  wine reg add 'HKLM\Software\Wine\Ports' /v $com /d "$(readlink "$work/one")" /f >/dev/null 2>&1
done
wineserver -k 2>/dev/null || true
wine cmd /c exit >/dev/null 2>&1  # reads the registry
cat >"$work/ipos" <<WRAPPER
#!/bin/sh
exec wine "$exe" "\$@"
WRAPPER
chmod +x "$work/ipos"
# A master says what it has checked: no FAIL, and "end" (tests/realbus/checks.py). A program of Windows knows
# no signals: it is ended without a word, and so without the report that says how late it was.
# That is one FAIL of each, which does not count, as is what is said of a pseudo-terminal.
no_parity="says nothing of an error: ['ipos: warning: COM3: the device has no parity: neither sends it nor sees its errors'] instead"
master() {
  (cd tests/realbus && timeout 300 /usr/bin/python3 -B "$@") >"$work/out" 2>&1 || true
  ! grep '^FAIL' "$work/out" | grep -vF "$no_parity" | grep -qvE 'ended by the signal|every restart has its reason' || fail "$1: $(cat "$work/out")"
  grep -q '^end' "$work/out" || fail "$1: $(cat "$work/out")"
  checks=$((checks + $(grep -c '^ok' "$work/out")))
}
checks=0
# Under wine the run is up to 12 ms late, and a pseudo-terminal has no wire time: an answer that the master has heard is still on
# the simulated line.
export IPOS_PAUSE=0.03
sed 's|kind = "rs485"|&\nport = "COM12"|' tests/realbus/movilink.toml >"$work/movilink.toml"
sed 's|kind = "profibus"|&\nport = "COM3"|' tests/realbus/profibus_plant.toml >"$work/dp.toml"
/usr/bin/python3 -c 'import serial' 2>/dev/null && master movilink_peer.py "$work/ipos" "$work/movilink.toml" "$work/two"
master profibus_master.py "$work/ipos" "$work/dp.toml" "$work/two" 300 100 0

# A COM port that goes away ends the run, as a device does on Linux.
wine "$exe" run "$work/movilink.toml" --realtime --for 600s >"$work/run" 2>&1 &
started+=($!)
wait_for "$work/run" 'is joined to COM12'
grep -q 'COM12: the device has no parity' "$work/run" || fail "parity of a pseudo-terminal: $(cat "$work/run")"
run=$!
kill "${started[-2]}"
code=0
wait $run || code=$?
[ $code = 74 ] || fail "COM12 gone: exit code $code: $(cat "$work/run")"
grep -q 'COM12: the device has gone: Input/output error' "$work/run" || fail "COM12 gone: $(cat "$work/run")"
windows param get --port 'COM33' --address 1 P130 >"$work/out" 2>&1 && fail "COM33"
grep -q 'COM33: there is no such device: there is .*COM' "$work/out" || fail "COM33: $(cat "$work/out")"

echo "$adapter adapters; $checks checks of masters at COM3 and COM12"
