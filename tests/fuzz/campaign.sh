#!/usr/bin/env bash
# A campaign with one target of a build with the preset `fuzz`: `campaign.sh BUILD TARGET RUNS [LENGTH [OPTION...]]`. Inputs
# have LENGTH bytes at most (96); OPTIONs are libFuzzer's, such as -max_total_time=600 -seed=2. What it found is kept in
# BUILD/campaign/TARGET, so the next one goes on from there; what of it reaches code that corpus/TARGET.ar does not is put
# there. With 0 runs corpus/TARGET.ar is put together anew: the inputs with a name stay, and of all others as few as reach
# the same. Prints executions, executions a second of processor time and coverage, for README.md. A finding ends it; its
# input is BUILD/campaign/TARGET-crash-*.
set -euo pipefail
build=$(cd "$1" && pwd) target=$2 runs=$3 length=${4:-96}
shift $(($# < 4 ? $# : 4))
here=$(cd "$(dirname "$0")" && pwd)
corpus=$build/campaign/corpus/$target
found=$build/campaign/$target
seeds=$build/tests/fuzz/seeds
mkdir -p "$found"
exec {lock}>"$found.lock"
flock "$lock" # another one would take away what this one merges
"$here/corpora.sh" unpack "$build/campaign/corpus" "$target"
words=() more=()
for dict in "$here/$target.dict" "$seeds/$target.dict"; do
  [ ! -e "$dict" ] || words=("-dict=$dict")
done
[ ! -d "$seeds/$target" ] || more=("$seeds/$target")
fuzz() { nice -n "${IPOS_FUZZ_NICE:-19}" "$build/tests/fuzz/ipos_fuzz_$target" -detect_leaks=0 -entropic=0 "$@" 2>>"$found.log"; }
merge() { fuzz -merge=1 -use_counters=0 -max_len=65536 "$@"; } # inputs of the corpus may be longer, and are not cut
size_of() { echo "$(find "$corpus" -type f | wc -l) inputs, $(find "$corpus" -type f -printf '%s\n' | awk '{s += $1} END {print s + 0}') bytes"; }

: >"$found.log"
before=$(size_of)
cd "$build/campaign" # serve writes its history here
if [ "$runs" -eq 0 ]; then
  least=$(mktemp -d "$found.XXXXXX")
  find "$corpus" -type f ! -regex '.*/[0-9a-f]+' -exec cp -t "$least" {} +
  merge "$least" "$found" "$corpus"
  find "$corpus" -type f -delete
  cp -t "$corpus" "$least"/*
  rm -r "$least"
else
  # What leaks is found by the replay of the corpus, which ends with a look for leaks.
  TIMEFORMAT='%U %S'
  { time IPOS_FUZZ_KEEP=1000 fuzz -runs="$runs" -max_len="$length" "${words[@]}" -len_control=0 -print_final_stats=1 \
    -artifact_prefix="$found-" "$@" "$found" "$corpus" "${more[@]}"; } 2>"$found.time" ||
    { tail -n 40 "$found.log"; exit 1; }
  grep -E "INITED|DONE" "$found.log"
  awk -v units="$(grep -Po 'number_of_executed_units: \K\d+' "$found.log")" \
    '{printf "%d executions, %d a second\n", units, units / ($1 + $2)}' "$found.time"
  merge "$corpus" "$found"
fi
"$here/corpora.sh" pack "$build/campaign/corpus" "$target"
echo "before: $before; now: $(size_of)"
