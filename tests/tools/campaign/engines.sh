#!/bin/sh
# The scripts of examples/campaign with the engines that are there: engines.sh IPOS SOURCE LIBRARY ENGINE. Each gives what one run
# gives, to the byte. 77: the engine is not there.
set -eu
ipos=$1 source=$2 library=$3 engine=$4
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
skip() { echo "$1: skipped"; exit 77; }
case $engine in
  parallel) command -v parallel >/dev/null || skip "GNU parallel is not installed" ;;
  slurm) { command -v sbatch && timeout 10 sinfo; } >/dev/null 2>&1 || skip "there is no Slurm" ;;
  dask) /usr/bin/python3 -c 'import distributed' 2>/dev/null || skip "python3-distributed is not installed" ;;
esac
mkdir "$work/bin"
ln -s "$ipos" "$work/bin/ipos"
PATH=$work/bin:$PATH
PYTHONPATH=$source/python IPOS_PLANT_LIBRARY=$library PYTHONDONTWRITEBYTECODE=1
export PATH PYTHONPATH IPOS_PLANT_LIBRARY PYTHONDONTWRITEBYTECODE
cp "$source"/examples/campaign/*.IPC "$source"/examples/campaign/*.toml "$work"
cd "$work"
sed -i 's/^steps = 100/steps = 5/; s/1\.\.100/1..2/' line.campaign.toml  # 1000 cases
ipos campaign run line.campaign.toml --out one >/dev/null
ipos campaign merge one --csv one.csv >/dev/null
case $engine in
  dask) /usr/bin/python3 "$source/examples/campaign/dask.py" line.campaign.toml out 4 ;;
  *) sh "$source/examples/campaign/$engine.sh" line.campaign.toml out 4 ;;
esac
cmp one.csv out/results.csv
[ "$(wc -l <one.csv)" = 1001 ]
