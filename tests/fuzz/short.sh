#!/usr/bin/env bash
# A short run of every target with a fixed seed: `short.sh BUILD [RUNS]`, of a build with the preset `asan` or `fuzz`. First
# each replays its corpus, with a look for leaks. The targets are those of the folder, so one that is not built is a
# failure, and so is one without inputs. Nothing is written to the archives of inputs; inputs that fail are left in BUILD/short. As
# many targets run at a time as there are processors.
set -uo pipefail
build=$(cd "$1" && pwd)/tests/fuzz runs=${2:-3000}
here=$(cd "$(dirname "$0")" && pwd)
out=$build/short
export build runs here out
rm -rf "$out"
mkdir -p "$out"
"$here/corpora.sh" unpack "$build/corpus"
cd "$out" || exit # serve writes its history here

short_run() {
  local target=$1 program=$build/ipos_fuzz_$1 began=$EPOCHREALTIME
  local inputs=("$build/corpus/$target")
  [ ! -d "$build/seeds/$target" ] || inputs+=("$build/seeds/$target")
  mkdir "$out/$target"
  if [ ! -x "$program" ]; then
    echo "$target: not built"
  elif [ -z "$(ls "$build/corpus/$target" 2>/dev/null)" ]; then
    echo "$target: no inputs in corpus/$target.ar"
  elif ! "$program" -runs=0 "${inputs[@]}" >"$target.log" 2>&1 ||
    ! IPOS_FUZZ_KEEP=1000 "$program" -runs="$runs" -seed=1 -max_len=96 -len_control=0 -entropic=0 -detect_leaks=0 -timeout=30 \
      -print_final_stats=1 -artifact_prefix="$out/$target-" "$target" "${inputs[@]}" >>"$target.log" 2>&1; then
    echo "$target: failed"
    tail -n 40 "$target.log"
  else
    echo "$target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$target.log" | tail -n 1) executions," \
      "$(awk -v a="$began" -v b="$EPOCHREALTIME" 'BEGIN {printf "%.1f", b - a}') s"
    touch "$target.passed"
  fi
}
export -f short_run

# The largest corpora take longest, so they begin.
mapfile -t targets < <(cd "$here" && for source in *_fuzz.cpp; do
  target=${source%_fuzz.cpp}
  echo "$(cat "$build/corpus/$target"/* "$build/seeds/$target"/* 2>/dev/null | wc -c) $target"
done | sort -rn | cut -d' ' -f2)
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I{} bash -c 'short_run {}'
failed=()
for target in "${targets[@]}"; do
  [ -e "$target.passed" ] || failed+=("$target")
done
[ ${#failed[@]} -eq 0 ] || { echo "failed: ${failed[*]}"; exit 1; }
