#!/usr/bin/env bash
# The file for firmware, ipos.c, as strict C99 with gcc and clang and for a Cortex-M0+: every language program, the examples
# and 1500 programs by chance give the hashes of states that the interpreter of the simulation gives. The parts that can be
# left out are left out, one by one and all: each compiles and still loads and runs a program.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
runs=$3
file=$build/firmware
strict=(-std=c99 -Wall -Wextra -pedantic -Wshadow -Wcast-align -Werror -I "$file" -I "$source")
runner=$source/tests/embedding/firmware_run.c
board=$source/examples/embedding/cortex-m
"$runs" "$work/runs.bin" "$work/expected.txt" 1500
[ "$(wc -l <"$work/expected.txt")" -gt 1700 ] || fail "there are few programs"

compilers=("$CC -O2" "$CC -Os")
if command -v clang >/dev/null; then compilers+=("clang -O2" "clang -O1 -fsanitize=address,undefined -fno-sanitize-recover=all"); fi
for compiler in "${compilers[@]}"; do
  $compiler "${strict[@]}" "$file/ipos.c" "$runner" -o "$work/host"
  "$work/host" "$work/runs.bin" >"$work/host.txt"
  cmp "$work/host.txt" "$work/expected.txt" || fail "$compiler"
  echo "$(wc -l <"$work/host.txt") programs as in the simulation: $compiler"
done

for without in TEXTS TELEGRAMS INTERRUPTS ALL; do
  flags=(-DIPOS_$without=0)
  [ $without != ALL ] || flags=(-DIPOS_TEXTS=0 -DIPOS_TELEGRAMS=0 -DIPOS_INTERRUPTS=0)
  "$CC" -Os "${strict[@]}" "${flags[@]}" "$file/ipos.c" "$source/tests/embedding/firmware_parts.c" -o "$work/parts"
  "$work/parts" || fail "without $without"
done

need arm-none-eabi-gcc
need qemu-system-arm
cd "$work"
sed 's/LENGTH = 256K/LENGTH = 4M/' "$board/mps2.ld" >mps2.ld
core=(arm-none-eabi-gcc -mcpu=cortex-m0plus -mthumb -Os -ffunction-sections -fdata-sections -DFIRMWARE_BOARD)
"${core[@]}" "${strict[@]}" -c "$file/ipos.c" "$runner"
"${core[@]}" ipos.o firmware_run.o "$board/board_mps2.c" "$source/tests/embedding/firmware_runs.S" \
  -nostartfiles -nodefaultlibs -Wl,--gc-sections -Tmps2.ld -lc -lgcc -o firmware.elf
timeout 240 qemu-system-arm -M mps2-an385 -nographic -semihosting-config enable=on,target=native -kernel firmware.elf \
  </dev/null >m0.txt 2>&1
cmp m0.txt expected.txt || fail "on the Cortex-M"
echo "$(wc -l <m0.txt) programs as in the simulation: arm-none-eabi-gcc for Cortex-M0+, in QEMU"
