#!/bin/sh
# A campaign as a job array of Slurm: slurm.sh FILE DIR SHARDS. The folder must be one that all nodes see. A task whose node dies is
# queued again (--requeue) and goes on where it was; one that is killed alone is submitted once more at the end.
# `ipos campaign plan` says how many shards are worth a task each.
set -eu
file=$(realpath "$1") shards=$3
mkdir -p "$2"
dir=$(realpath "$2")
export file dir shards
tries=3
while :; do
  # 1 tells that a case failed: the task has done its work.
  job=$(sbatch --parsable --requeue --array="1-$shards" --job-name=ipos --output="$dir/slurm-%a.log" --open-mode=append --export=ALL \
    --wrap 'ipos campaign run "$file" --shard "$SLURM_ARRAY_TASK_ID/$shards" --out "$dir" --jobs "${SLURM_CPUS_PER_TASK:-1}" || [ $? = 1 ]')
  while [ -n "$(squeue --noheader --job "$job" 2>/dev/null)" ]; do sleep 2; done
  status=0
  ipos campaign merge "$dir" --csv "$dir/results.csv" || status=$?
  tries=$((tries - 1))
  # 65 tells that cases are missing.
  [ "$status" = 65 ] && [ "$tries" -gt 0 ] || exit "$status"
done
