#!/bin/sh
# A campaign as a job array of Slurm: slurm.sh FILE DIR SHARDS. The folder must be one that all nodes see. A task whose node dies is
# queued again (--requeue) and goes on where it was; `ipos campaign plan` says how many shards are worth a task each.
set -eu
file=$(realpath "$1") shards=$3
mkdir -p "$2"
dir=$(realpath "$2")
export file dir shards
# 1 tells that a case failed: the task has done its work.
job=$(sbatch --parsable --requeue --array="1-$shards" --job-name=ipos --output="$dir/slurm-%a.log" --open-mode=append --export=ALL \
  --wrap 'ipos campaign run "$file" --shard "$SLURM_ARRAY_TASK_ID/$shards" --out "$dir" --jobs "${SLURM_CPUS_PER_TASK:-1}" || [ $? = 1 ]')
while [ -n "$(squeue --noheader --job "$job" 2>/dev/null)" ]; do sleep 2; done
exec ipos campaign merge "$dir" --csv "$dir/results.csv"
