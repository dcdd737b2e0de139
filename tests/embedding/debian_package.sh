#!/usr/bin/env bash
# CPack makes a Debian package; its files, unpacked into an empty folder, are enough to build and run a program.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
. "$(dirname "$0")/hello_project.sh"
need dpkg-deb
need dpkg-shlibdeps
cd "$work"
cpack --config "$build/CPackConfig.cmake" -B "$work/pack" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
package=$(find "$work/pack" -maxdepth 1 -name 'ipos_*.deb')
dpkg-deb -f "$package" Package Version Depends
dpkg-deb -x "$package" "$work/root"
lib=$(dirname "$(find "$work/root" -name libipos.a)")
write_project "$work/project" "find_package(ipos REQUIRED)" compile
cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$work/root/usr" >/dev/null
cmake --build "$work/project/build" >/dev/null
expect "$("$work/project/build/hello" | wc -l)" 3
LD_LIBRARY_PATH=$lib "$work/root/usr/bin/ipos" --version
for file in share/man/man1/ipos.1 share/bash-completion/completions/ipos share/zsh/vendor-completions/_ipos \
  share/fish/vendor_completions.d/ipos.fish share/doc/ipos/docs/guide/embedding.md share/doc/ipos/examples/scom/scom.toml; do
  [ -s "$work/root/usr/$file" ] || [ -s "$work/root/usr/$file.gz" ] || fail "the package has no $file"
done
