#!/usr/bin/env bash
# The inputs of a fuzz target are kept in one archive, corpus/TARGET.ar, so that thousands of small files do not stand in
# the checkout. `corpora.sh unpack FOLDER [TARGET...]` writes the inputs to FOLDER/TARGET, of all targets where none is
# named, in place of what is there; `corpora.sh pack FOLDER TARGET...` makes the archives of them. The same inputs give the same bytes.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
order=$1 folder=$2
shift 2
targets=("$@")
if [ ${#targets[@]} -eq 0 ]; then
  for archive in "$here"/corpus/*.ar; do targets+=("$(basename "$archive" .ar)"); done
fi
for target in "${targets[@]}"; do
  archive=$here/corpus/$target.ar
  case $order in
    unpack)
      rm -rf "${folder:?}/$target"
      mkdir -p "$folder/$target"
      [ ! -e "$archive" ] || (cd "$folder/$target" && ar x "$archive")
      ;;
    pack)
      (cd "$folder/$target" && find . -type f -printf '%P\n' | LC_ALL=C sort | xargs -d '\n' ar qcDS "$archive.new")
      mv "$archive.new" "$archive"
      ;;
  esac
done
