#!/usr/bin/env bash
# CPack makes a Debian package; its files, unpacked into an empty folder, are enough to build and run a program. As
# root the package is installed, used from another folder, and removed, on overlays of /usr and of dpkg's lists that
# nobody else sees.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
. "$(dirname "$0")/hello_project.sh"
need dpkg-deb
need dpkg-shlibdeps
cd "$work"
vsix=$build/vscode/ipos.vsix
[ -e "$vsix" ] || "$source/tools/vscode/pack.sh" "$vsix" || { [ $? = 69 ] && vsix=; }
cpack --config "$build/CPackConfig.cmake" -B "$work/pack" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
package=$(find "$work/pack" -maxdepth 1 -name 'ipos_*.deb')
dpkg-deb -f "$package" Package Version Depends
dpkg-deb -x "$package" "$work/root"
lib=$(dirname "$(find "$work/root" -name libipos.a)")
write_project "$work/project" "find_package(ipos REQUIRED)" compile
cmake -S "$work/project" -B "$work/project/build" -DCMAKE_PREFIX_PATH="$work/root/usr" >/dev/null
cmake --build "$work/project/build" >/dev/null
expect "$("$work/project/build/hello" | wc -l)" 3
"$work/root/usr/bin/ipos" --version
[ -z "$vsix" ] || cmp "$vsix" "$work/root/usr/share/ipos/ipos.vsix"
for file in share/man/man1/ipos.1 share/bash-completion/completions/ipos share/zsh/vendor-completions/_ipos \
  share/fish/vendor_completions.d/ipos.fish share/doc/ipos/docs/guide/embedding.md share/doc/ipos/examples/scom/scom.toml \
  include/ipos_plant.h lib/python3/dist-packages/ipos/plant.py; do
  [ -s "$work/root/usr/$file" ] || [ -s "$work/root/usr/$file.gz" ] || fail "the package has no $file"
done
[ -e "$work/root/usr/lib/python3/dist-packages/ipos/py.typed" ] || fail "the Python package of the package is not marked as typed"
for words in copyright:'MIT License' copyright:preact copyright:Boost changelog.gz:unstable; do
  zcat -f "$work/root/usr/share/doc/ipos/${words%%:*}" | grep "${words#*:}" >/dev/null || fail "${words%%:*} has no ${words#*:}"
done
# What Debian's policy forbids; `./dev release` installs it.
command -v lintian >/dev/null && { lintian --fail-on error "$package" >"$work/lintian" 2>&1 || fail "$(cat "$work/lintian")"; }

[ "$(id -u)" = 0 ] || { echo "not installed: that takes root"; exit 0; }
# The folders of the overlays must not lie on an overlay themselves.
mkdir "$work/over"
overlays='mount -t tmpfs none "$work/over" && mkdir "$work"/over/{usr,usr.work,dpkg,dpkg.work} &&
  mount -t overlay overlay -o "lowerdir=/usr,upperdir=$work/over/usr,workdir=$work/over/usr.work" /usr &&
  mount -t overlay overlay -o "lowerdir=/var/lib/dpkg,upperdir=$work/over/dpkg,workdir=$work/over/dpkg.work" /var/lib/dpkg'
export work package source vsix CC overlays
unshare -m bash -c "$overlays" 2>/dev/null || { echo "not installed: no overlays here"; exit 0; }
unshare -m bash -c '
  set -euo pipefail
  eval "$overlays"
  # Small images leave pages and manuals out.
  dpkg -i --path-include="/usr/share/*" "$package" >/dev/null
  mkdir "$work/elsewhere"
  cd "$work/elsewhere"
  ipos new line >/dev/null
  ipos test line
  cp /usr/share/doc/ipos/examples/scom/* .
  # Not into head, which may be gone before all is written.
  ipos run scom.toml --for 1s --watch >watched 2>/dev/null
  head -n 1 watched
  printf "%.5s" "$(zcat -f /usr/share/man/man1/ipos.1*)"
  [ -z "$vsix" ] || [ -s /usr/share/ipos/ipos.vsix ]
  "$CC" -std=c99 "$source/examples/embedding/c/hello.c" -o hello $(pkg-config --cflags --libs ipos_compile)
  ./hello
  /usr/bin/python3 -c "import ipos; plant = ipos.Plant(\"scom.toml\"); plant.run(\"1s\"); print(hex(plant[\"unit2\"][\"lReDataLow\"]))"
  dpkg -r ipos >/dev/null
  [ ! -e /usr/bin/ipos ] && [ ! -e /usr/share/doc/ipos ] && [ ! -e /usr/share/ipos ] && [ ! -e /usr/include/ipos.h ]
' >"$work/installed" 2>&1 || fail "$(cat "$work/installed")"
expect "$(cat "$work/installed")" "ok      line/line  3 checks in 8.000 s
1 test, 1 passed
unit1 (MOVIDRIVE MD_60A), SCOM1.IPC
.TH Iafter 100 ms: speed = 140
after 200 ms: speed = 180
after 300 ms: speed = 225
0x11223344"
