#!/usr/bin/env bash
# A campaign with one target of a build with the preset `fuzz`: `campaign.sh BUILD TARGET RUNS [LENGTH]`. Inputs have LENGTH
# bytes at most (96). What it found is kept in BUILD/campaign/TARGET, so the next one goes on from there; what of it reaches
# code that corpus/TARGET does not is put there. Prints executions, executions a second and coverage, for README.md. A
# finding ends it; its input is BUILD/campaign/TARGET-crash-*.
set -euo pipefail
build=$(cd "$1" && pwd) target=$2 runs=$3 length=${4:-96}
here=$(cd "$(dirname "$0")" && pwd)
corpus=$here/corpus/$target
found=$build/campaign/$target
mkdir -p "$found" "$corpus"
words=()
[ ! -e "$here/$target.dict" ] || words=("-dict=$here/$target.dict")
fuzz() { nice -n 19 "$build/tests/fuzz/ipos_fuzz_$target" -detect_leaks=0 -entropic=0 "$@" 2>>"$found.log"; }

: >"$found.log"
# What leaks is found by the replay of the corpus, which ends with a look for leaks.
cd "$build/campaign" # serve writes its history here
IPOS_FUZZ_KEEP=1000 fuzz -runs="$runs" "${words[@]}" -max_len="$length" -len_control=0 -print_final_stats=1 -artifact_prefix="$found-" "$found" "$corpus" ||
  { tail -n 40 "$found.log"; exit 1; }
grep -E "DONE|number_of_executed|average_exec" "$found.log"
before=$(find "$corpus" -type f | wc -l)
fuzz -merge=1 -use_counters=0 -max_len="$length" "$corpus" "$found"
echo "inputs: $before before, $(find "$corpus" -type f | wc -l) now, $(du -sb "$corpus" | cut -f1) bytes"
