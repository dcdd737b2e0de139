#!/usr/bin/env bash
# What takes too long for every test run: all sources read by clang, all suites with AddressSanitizer and UBSan, what
# has threads with ThreadSanitizer, the examples under valgrind, and the tutorial in an empty Debian. Prints the time of
# each part; goes on after a failure.
#   tests/check/check.sh              all parts
#   tests/check/check.sh PART...      of: asan clang tsan valgrind tutorial
set -uo pipefail
cd "$(dirname "$0")/../.."
jobs=$(nproc)
[ $# -gt 0 ] || set -- asan clang tsan valgrind tutorial

# Programs with threads: `ipos test -j` and the reader behind the ports and the page.
threaded=(ipos_testing_tests ipos_port_tests ipos_serve_tests ipos_library_tests)
# Not for sanitizers: they count instructions and allocations, run another processor's code, boot a kernel, or build
# the project anew.
unfit='ipos_bench|aarch64|ipos_realbus|ipos_memcheck|ipos_debian|ipos_install|ipos_subdirectory|ipos_hello|cortex|ipos_pictures|conformance'

configure() { cmake --preset "$1" -DIPOS_TESTS=ON >/dev/null; }

asan() {
  configure asan && cmake --build --preset asan -j "$jobs" || return 1
  ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 \
    ctest --preset asan --parallel "$jobs" -E "$unfit" --timeout 900
}

clang() { # a build that has the generated sources and knows the commands
  configure asan && tests/check/clang_reads.py build/asan
}

tsan() {
  configure tsan && cmake --build --preset tsan -j "$jobs" --target "${threaded[@]}" || return 1
  TSAN_OPTIONS=halt_on_error=1:second_deadlock_stack=1 \
    ctest --preset tsan -R "^($(IFS='|'; echo "${threaded[*]}"))\$" --timeout 900
}

valgrind() {
  local ipos=
  for ipos in build/release/tools/ipos build/dev/tools/ipos; do
    [ -x "$ipos" ] && break
  done
  tests/examples/memcheck.sh "$ipos"
}

tutorial() {
  configure release && cmake --build --preset release --target ipos_static || return 1
  local status=0
  tests/docs/empty_debian.sh build/release/static/ipos docs/guide/tutorial.md || status=$?
  [ $status -eq 0 ] || [ $status -eq 77 ]
}

failed=()
times=()
for part in "$@"; do
  case $part in asan | clang | tsan | valgrind | tutorial) ;; *) sed -n '5,6s/^# *//p' "$0"; exit 64 ;; esac
  echo "== $part"
  began=$SECONDS
  "$part" || failed+=("$part")
  times+=("$part $((SECONDS - began)) s")
done
printf '%s\n' "${times[@]}"
[ ${#failed[@]} -eq 0 ] || { echo "failed: ${failed[*]}"; exit 1; }
