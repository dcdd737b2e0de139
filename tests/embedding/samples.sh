#!/usr/bin/env bash
# The samples of examples/embedding do what they say.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
samples=$build/examples/embedding ipos=$build/tools/ipos

# 100 + 5 for every 10 ms of waiting and the two commands between (1 command a millisecond): 12 ms a turn.
expect "$("$samples/ipos_sample_c" | tail -n 1 | sed 's/ = .*//')" "after 300 ms: speed"
"$samples/ipos_sample_cpp" | tee "$work/cpp"
expect "$(cat "$work/cpp")" "peak after 100 ms grows on: yes, and is back after restoring: yes"

"$ipos" build "$source/examples/embedding/drive/POSITION.IPC" --unit md60a -o "$work/POSITION.ipx"
expect "$("$samples/ipos_sample_drive" "$work/POSITION.ipx")" "no task of the program runs; position 500, H0 4"
printf 'main() { _TouchProbe(1); }\n' > "$work/bad.IPC"
"$ipos" build "$work/bad.IPC" --unit md60a -o "$work/bad.ipx"
expect "$("$samples/ipos_sample_drive" "$work/bad.ipx" | head -n 1)" "F10 at word 0: this drive does not have the command"

if [ -x "$samples/ipos_sample_asio" ]; then
  for n in 1 2; do "$ipos" build "$source/examples/scom/SCOM$n.IPC" -o "$work/SCOM$n.ipx"; done
  expect "$("$samples/ipos_sample_asio" "$work/SCOM1.ipx" "$work/SCOM2.ipx")" \
         "one received: yes 44332211, two received: yes 11223344"
else
  echo "the asio sample is not built: libasio-dev is not installed"
fi
