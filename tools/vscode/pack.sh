#!/usr/bin/env bash
# Builds the extension in a folder beside the result, so that nothing is written among the sources.
# usage: pack.sh OUT.vsix      Exit code 69 and the reason where npm or its registry is missing.
set -euo pipefail
out=$(realpath -m "$1")
source=$(realpath "$(dirname "$0")")
command -v npm >/dev/null || { echo "pack.sh: npm is not installed" >&2; exit 69; }
folder=$(dirname "$out")/extension
mkdir -p "$folder"
tar -C "$source" --exclude=node_modules --exclude=out --exclude='*.vsix' -cf - . | tar -C "$folder" -xf -
cd "$folder"
# No script of a package is run: some would fetch programs from elsewhere.
npm ci --ignore-scripts --no-audit --no-fund --prefer-offline --fetch-retries=1 >npm.log 2>&1 ||
  { cat npm.log >&2; echo "pack.sh: the packages of the extension cannot be installed" >&2; exit 69; }
cmake -DIN=extension -DOUT=NOTICES.txt -P "$source/../../cmake/notices.cmake"
npm run package >npm.log 2>&1 || { cat npm.log >&2; exit 1; }
mv ipos.vsix "$out"
