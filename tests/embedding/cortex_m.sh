#!/usr/bin/env bash
# The sample firmware runs SCOM1 in QEMU, built for a Cortex-M0+, M3 and M4F: values are those of the manual, the hash over
# all commands and frames is that of the host, and flash and RAM stay within their limits (M0+). QEMU has no board with a
# Cortex-M0+; the M3, whose instructions contain those of the M0+, executes that firmware.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
need arm-none-eabi-g++
need qemu-system-arm
need ninja
flash=16384 ram=2048
firmware=$source/examples/embedding/cortex-m
"$build/tools/ipos" build "$source/examples/scom/SCOM1.IPC" -o "$work/SCOM1.ipx"

for core in m0:mps2-an385 m3:mps2-an385 m4f:mps2-an386; do
  folder=$work/${core%:*}
  (cd "$source" && cmake --preset "cortex-${core%:*}" -B "$folder" -DIPOS_IMAGE="$work/SCOM1.ipx" >/dev/null)
  cmake --build "$folder" -j1 >"$work/log" || fail "$(tail -n 30 "$work/log")"
  timeout 60 qemu-system-arm -M "${core#*:}" -nographic -semihosting-config enable=on,target=native \
    -kernel "$folder/examples/embedding/cortex-m/firmware" </dev/null >"$work/${core%:*}.txt" 2>&1 ||
    fail "$(cat "$work/${core%:*}.txt")"
done

generated=$work/m0/examples/embedding/cortex-m
"$CC" -std=c11 -I "$source/embed/include" -I "$build/include" "$firmware"/{scom,can_mock,board_host}.c "$generated/image.c" \
  "$build/lib/libipos.a" -o "$work/host"
"$work/host" | tee "$work/host.txt"
for core in m0 m3 m4f; do diff "$work/host.txt" "$work/$core.txt"; done
grep -q '^as the manual prints it$' "$work/host.txt"
python3 "$firmware/size_report.py" "$work/m0" --flash $flash --ram $ram
