#!/usr/bin/env bash
# Machine code for AArch64 on another processor: the VM and its tests by a cross compiler, on an emulator.
#   aarch64.sh test FOLDER IPOS_ENGINES    builds in FOLDER and runs; 77, with the reason, where something is missing
#   aarch64.sh fetch FOLDER                gets asmjit for AArch64 there, by Debian's tools, without a trace elsewhere
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "${2:?}"
folder=$(cd "$2" && pwd)
asmjit=$folder/asmjit/usr/lib/aarch64-linux-gnu/cmake/asmjit

fetch() {
  [ -e "$asmjit" ] && return
  local apt=$folder/apt
  mkdir -p "$apt/lists/partial" "$apt/archives/partial"
  cat > "$apt/apt.conf" <<EOF
APT { Architecture "arm64"; Architectures { "arm64"; }; Sandbox::User "root"; };
Dir { State "$apt"; State::status "/dev/null"; Cache "$apt"; };
EOF
  export APT_CONFIG=$apt/apt.conf
  apt-get update -qq
  (cd "$apt" && apt-get download -qq libasmjit-dev)
  dpkg-deb -x "$apt"/libasmjit-dev_*.deb "$folder/asmjit"
  rm -rf "$apt"
}

skip() {
  echo "skipped: $*"
  exit 77
}

run_tests() {
  local engines=$1 emulator
  [ "$(uname -m)" != aarch64 ] || skip "this processor is one, the other tests are of its machine code"
  command -v aarch64-linux-gnu-g++ >/dev/null || skip "no aarch64-linux-gnu-g++ (Debian: g++-aarch64-linux-gnu)"
  emulator=$(command -v qemu-aarch64 || command -v qemu-aarch64-static) || skip "no qemu-aarch64 (Debian: qemu-user)"
  [ -e "$asmjit" ] || skip "no asmjit for AArch64; '$0 fetch $folder' gets it"
  [ -e /usr/src/googletest ] || skip "no sources of GoogleTest (Debian: googletest)"

  cmake -S "$here/aarch64" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -Dasmjit_DIR="$asmjit" \
    -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_SYSTEM_PROCESSOR=aarch64 -DCMAKE_EXE_LINKER_FLAGS=-static \
    -DCMAKE_C_COMPILER=aarch64-linux-gnu-gcc -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++ >/dev/null
  cmake --build "$folder/build" --parallel "$(nproc)" --target ipos_engines_replay ipos_native_tests >"$folder/build.log" ||
    { cat "$folder/build.log"; exit 1; }
  "$emulator" "$folder/build/ipos_native_tests"
  "$engines" --count 200 --write "$folder/programs.txt"
  "$emulator" "$folder/build/ipos_engines_replay" "$folder/programs.txt"
}

case "${1:?}" in
  fetch) fetch ;;
  test) run_tests "${3:?}" ;;
  *) exit 64 ;;
esac
