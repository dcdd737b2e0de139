#!/bin/sh
# boot.sh FOLDER IPOS PROJECT WIDE_REGISTERS: boots user-mode-linux on the root file system of this machine and runs
# guest.sh in it, which leaves its findings in FOLDER. WIDE_REGISTERS is the library of wide_registers.c, for processors
# with AMX. Exit code 77: it does not boot here; the reason is the last line of stdout.
set -u
folder=$1 ipos=$2 project=$3 wide_registers=$4
for tool in linux.uml candump cansend canbusload cangen slcand busybox ip tc; do
  command -v $tool >/dev/null || { echo "there is no $tool"; exit 77; }
done
ln -s "$ipos" "$folder/ipos"
ln -s "$project" "$folder/project"
preloaded=
if grep -qw amx_tile /proc/cpuinfo; then preloaded=$wide_registers; fi
# Its memory and its files of management lie in the folder, too. A guest that hangs is killed.
TMPDIR=$folder HOME=$folder LD_PRELOAD=$preloaded timeout -s KILL 900 linux.uml mem=192M rootfstype=hostfs rootflags=/ rw \
  init="$folder/project/tests/realbus/guest.sh" FOLDER="$folder" con=null con0=fd:0,fd:1 quiet \
  </dev/null >"$folder/console.txt" 2>&1
code=$?
[ -e "$folder/done" ] && exit 0
if [ -e "$folder/no-can" ]; then echo "the guest has no CAN: $(cat "$folder/no-can")"; exit 77; fi
if [ -e "$folder/booted" ]; then echo "the guest has not come to its end:"; cat "$folder/console.txt"; exit 1; fi
reason=$(grep -m 1 "Kernel panic" "$folder/console.txt" || tail -n 1 "$folder/console.txt")
echo "user-mode-linux does not boot here (exit code $code): $reason"
exit 77
