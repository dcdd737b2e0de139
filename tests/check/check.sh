#!/usr/bin/env bash
# What takes too long for every test run: all sources compiled by clang and all suites with AddressSanitizer and UBSan,
# every preset configured, a short run of every fuzz target, what has threads with ThreadSanitizer, the examples under
# valgrind, thousands of plants in the default way against --no-skip, ipos in WebAssembly against the native program, the
# tutorial in an empty Debian, and 500 releases of a button that moves a real drive, on a machine that has more to do than it
# can. Prints the time of each part; goes on after a failure.
#   tests/check/check.sh              all parts
#   tests/check/check.sh PART...      of: asan presets fuzz tsan valgrind skip web tutorial jog
set -uo pipefail
cd "$(dirname "$0")/../.." || exit
jobs=$(nproc)
parts='asan presets fuzz tsan valgrind skip web tutorial jog'
# shellcheck disable=SC2086
[ $# -gt 0 ] || set -- $parts

# Programs with threads: `ipos test -j` and the reader behind the ports and the page.
threaded=(ipos_testing_tests ipos_port_tests ipos_serve_tests ipos_library_tests)
# Not for sanitizers: they run another processor's code, boot a kernel, build the project anew, or start the program some
# thousand times (ipos_schemas: 40 s without sanitizers), or measure how long it takes (ipos_server_jog). The corpora of fuzzing are replayed by `fuzz`.
unfit='ipos_fuzz_replay|ipos_server_jog|ipos_schemas|aarch64|ipos_realbus|ipos_memcheck|ipos_debian|ipos_install|ipos_subdirectory|ipos_hello|cortex|ipos_pictures|conformance'

configure() { cmake --preset "$1" -DIPOS_TESTS=ON >/dev/null; }

asan() {
  local status=0  # what does not compile is told, and all others are asked
  configure asan || return 1
  cmake --build --preset asan -j "$jobs" -- -k 0 || status=1
  ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1 UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 \
    ctest --preset asan --parallel "$((jobs + 1))" -E "$unfit" --timeout 900 || status=1
  return $status
}

# The compiler that a preset names, or its toolchain file.
compiler_of() {
  local settings toolchain
  settings=$(cmake --preset "$1" -N)
  toolchain=$(sed -n 's/^ *CMAKE_TOOLCHAIN_FILE.*="\(.*\)"$/\1/p' <<<"$settings")
  if [ -n "$toolchain" ]; then
    sed -n 's/^set(CMAKE_CXX_COMPILER \(.*\))$/\1/p' "$toolchain"
  else
    sed -n 's/^ *CMAKE_CXX_COMPILER="\(.*\)"$/\1/p' <<<"$settings"
  fi
}

# Every preset can be configured, and its compiler makes the first layer; one without its compiler here is told.
presets() {
  local preset compiler target status=0
  for preset in $(cmake --list-presets | sed -n 's/^ *"\(.*\)" *-.*/\1/p'); do
    compiler=$(compiler_of "$preset") target=ipos_isa
    compiler=${compiler:-g++}
    case $preset in cortex-*) target=all ;; esac
    if ! command -v "$compiler" >/dev/null; then
      echo "preset $preset: no $compiler here"
    elif cmake --preset "$preset" -B "build/presets/$preset" >/dev/null &&
      cmake --build "build/presets/$preset" -j "$jobs" --target "$target" >/dev/null; then
      echo "preset $preset: configured, $target built"
    else
      status=1
    fi
  done
  rm -rf build/presets
  return $status
}

fuzz() { # the targets are those of the folder: one that is not built is missed
  local targets
  targets=$(cd tests/fuzz && printf 'ipos_fuzz_%s\n' *_fuzz.cpp | sed 's/_fuzz\.cpp$//')
  # shellcheck disable=SC2086
  configure asan && cmake --build --preset asan -j "$jobs" --target ipos_fuzz_seeds $targets &&
    ctest --preset asan -R '^ipos_fuzz_seeds$' >/dev/null && tests/fuzz/short.sh build/asan
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

skip() { # each processor has its share of the 5000
  configure release && cmake --build --preset release --target ipos_default_run_tests || return 1
  local plants=5000 tests share status=0 runs=()
  tests=$(find build/release/tests -name ipos_default_run_tests -type f)
  for ((share = 0; share < jobs; ++share)); do
    IPOS_FIRST_PLANT=$((plants * share / jobs + 1)) IPOS_PLANTS=$((plants * (share + 1) / jobs)) \
      "$tests" --gtest_brief=1 &
    runs+=($!)
  done
  for run in "${runs[@]}"; do wait "$run" || status=1; done
  return $status
}

web() { # one build of it, and all that shows that it does what the native program does
  cmake --preset web >/dev/null && cmake --build --preset web -j "$jobs" --target ipos_site ipos_wasm_package || return 1
  configure release && cmake --build --preset release --target ipos ipos_web_wasm_tests ipos_random_plants || return 1
  build/release/tests/web-wasm/ipos_web_wasm_tests
}

tutorial() {
  configure release && cmake --build --preset release --target ipos_static || return 1
  local status=0
  tests/docs/empty_debian.sh build/release/static/ipos docs/guide/tutorial.md || status=$?
  [ $status -eq 0 ] || [ $status -eq 77 ]
}

failed=()
times=()
# Twice as many busy loops as processors beside it.
jog() {
  local status=0 busy=()
  for _ in $(seq $((2 * jobs))); do
    while :; do :; done &
    busy+=($!)
  done
  python3 tests/serve/jog_test.py build/release/tools/ipos --releases 500 --everywhere HandOff.test_releases HandOff.test_whatever_ends || status=1
  kill "${busy[@]}"
  wait "${busy[@]}" 2>/dev/null
  return $status
}

for part in "$@"; do
  [[ " $parts " == *" $part "* ]] || { sed -n '7,8s/^# *//p' "$0"; exit 64; }
  echo "== $part"
  began=$SECONDS
  "$part" || failed+=("$part")
  times+=("$part $((SECONDS - began)) s")
done
printf '%s\n' "${times[@]}"
[ ${#failed[@]} -eq 0 ] || { echo "failed: ${failed[*]}"; exit 1; }
