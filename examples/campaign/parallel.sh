#!/bin/sh
# A campaign by GNU parallel: parallel.sh FILE DIR SHARDS. What else it takes goes to parallel, such as `--sshlogin a,b --wd .` for
# other machines that see the same folders.
set -eu
file=$1 dir=$2 shards=$3
shift 3
mkdir -p "$dir"
status=0
# A shard that is there already is looked at, and nothing of it is run again. 1 tells that a case failed.
seq "$shards" | parallel --will-cite --joblog "$dir/parallel.log" "$@" "ipos campaign run '$file' --shard {}/$shards --out '$dir' --jobs 1 || [ \$? = 1 ]" || status=$?
[ "$status" = 0 ] || { echo "$status shards were not run to their end; the same command goes on" >&2; exit 70; }
exec ipos campaign merge "$dir" --csv "$dir/results.csv"
