#!/usr/bin/env bash
# add_subdirectory gives a project the library alone: no generator, no package, no tool is needed.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
. "$(dirname "$0")/hello_project.sh"
write_project "$work/project" "add_subdirectory($source ipos)" library
cmake -S "$work/project" -B "$work/project/build" >/dev/null
cmake --build "$work/project/build" --target version >/dev/null
"$work/project/build/version"
