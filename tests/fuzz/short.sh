#!/usr/bin/env bash
# A short run of every target with a fixed seed: `short.sh BUILD [RUNS]`, of a build with the preset `fuzz`. First each
# replays its corpus, with a look for leaks. The targets are those of the folder, so one that is not built is a failure,
# and so is one without inputs. Nothing is written to the corpora; inputs that fail are left in BUILD/short.
set -uo pipefail
build=$(cd "$1" && pwd)/tests/fuzz runs=${2:-3000}
here=$(cd "$(dirname "$0")" && pwd)
out=$build/short
rm -rf "$out"
mkdir -p "$out"
cd "$out" # serve writes its history here
failed=()
for source in "$here"/*_fuzz.cpp; do
  target=$(basename "$source" _fuzz.cpp)
  program=$build/ipos_fuzz_$target
  inputs=("$here/corpus/$target")
  [ ! -d "$build/seeds/$target" ] || inputs+=("$build/seeds/$target")
  began=$EPOCHREALTIME
  mkdir "$out/$target"
  if [ ! -x "$program" ]; then
    echo "$target: not built"
  elif [ -z "$(ls "$here/corpus/$target" 2>/dev/null)" ]; then
    echo "$target: no inputs in corpus/$target"
  elif ! "$program" -runs=0 "${inputs[@]}" >"$target.log" 2>&1 ||
    ! IPOS_FUZZ_KEEP=1000 "$program" -runs="$runs" -seed=1 -max_len=96 -len_control=0 -entropic=0 -detect_leaks=0 -timeout=30 \
      -print_final_stats=1 -artifact_prefix="$out/$target-" "$target" "${inputs[@]}" >>"$target.log" 2>&1; then
    tail -n 40 "$target.log"
  else
    echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$target.log" | tail -n 1) executions," \
      "$(awk -v a="$began" -v b="$EPOCHREALTIME" 'BEGIN {printf "%.1f", b - a}') s"
    continue
  fi
  failed+=("$target")
done
[ ${#failed[@]} -eq 0 ] || { echo "failed: ${failed[*]}"; exit 1; }
