#!/usr/bin/env bash
# ipos_plant.dll as others get it: it shows the C functions of its header and nothing else, needs no DLL but those of Windows, is
# found by CMake in an installed tree that was moved, and a C client of it prints what the same client prints with the
# library of Linux. So does the DLL in the wheel for Windows. `./dev windows` builds it; ctest only tries what is built.
# usage: windows_library.sh SOURCE BUILD      BUILD has the library of Linux; the DLL is that of SOURCE/build/windows
set -euo pipefail
. "$(dirname "$0")/folder.sh"
cross=$source/build/windows
dll=$cross/lib/ipos_plant.dll
[ -f "$dll" ] || skip "there is no $dll: ./dev windows builds it"
for tool in wine x86_64-w64-mingw32-objdump x86_64-w64-mingw32-gcc-posix; do need "$tool"; done
export LC_ALL=C.UTF-8 WINEDEBUG=-all WINEDLLOVERRIDES='mscoree,mshtml=' WINEPREFIX=$cross/wine
mkdir -p "$WINEPREFIX"
wine cmd /c exit >/dev/null 2>&1 || skip "wine does not start"
cd "$source"

x86_64-w64-mingw32-objdump -p "$dll" >"$work/dll"
sed -n '/^\[Ordinal\/Name Pointer\] Table/,/^$/s/^\s*\[ *[0-9]*\] *//p' "$work/dll" | sort >"$work/exports"
sed -n 's/^ipos_plant //p' tests/embedding/abi/symbols.txt | sort | diff - "$work/exports"
sed -n 's/^\s*DLL Name: //p' "$work/dll" | tr '[:upper:]' '[:lower:]' | sort >"$work/imports"
# What Windows itself has, in every edition since 10.
unknown=$(grep -vxE 'kernel32|msvcrt|advapi32|user32|ws2_32|setupapi|shell32|api-ms-win-.*' <(sed 's/\.dll$//' "$work/imports") || true)
[ -z "$unknown" ] || fail "the DLL needs $unknown"

# Installed and moved: found by CMake, with the compiler that the tree of sources uses for Windows.
cmake --install "$cross" --prefix "$work/first" --strip >/dev/null
mv "$work/first" "$work/prefix"
mkdir "$work/client"
cat >"$work/client/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(client LANGUAGES C)
set(CMAKE_C_STANDARD 99)
find_package(ipos 0.1 REQUIRED)
add_executable(client ${CLIENT})
target_link_libraries(client PRIVATE ipos::plant)
CMAKE
cmake -S "$work/client" -B "$work/client/build" -DCMAKE_TOOLCHAIN_FILE="$source/cmake/mingw-w64.cmake" \
  -Dipos_DIR="$work/prefix/lib/cmake/ipos" -DCLIENT="$source/tests/embedding/plant_client.c" >/dev/null
cmake --build "$work/client/build" >/dev/null
cp "$work/client/build/client.exe" "$work/prefix/bin"
"$CC" -std=c99 -I "$source/runtime/library/include" tests/embedding/plant_client.c -o "$work/plant_client" \
  -L "$build/lib" -lipos_plant -Wl,-rpath,"$build/lib"

# A folder with letters that not every code page has.
mkdir "$work/Säge"
cp examples/scom/* "$work/Säge"
(cd "$work" && mv Säge/SCOM1.IPC "Säge/Räder.IPC" && sed -i 's/SCOM1.IPC/Räder.IPC/' Säge/scom.toml)
plants=(S%C3%A4ge/scom.toml)
for example in scom movilink-rs485 profibus canopen isync hoist flying-cut; do
  cp -r "examples/$example" "$work"
  plants+=("$example/$(basename "$(ls examples/$example/*.toml | grep -v '\.\(test\|campaign\)\.toml$' | head -n 1)")")
done
cd "$work"
./plant_client "${plants[@]}" >linux
wine prefix/bin/client.exe "${plants[@]}" | tr -d '\r' >windows
diff linux windows || fail "the DLL does something else"
expect "$(grep -c '^  hash: ' windows)" "${#plants[@]}"

# The wheel: its DLL is the one that is given away.
cp -r "$source/python" python
rm -rf python/build python/*.egg-info
(cd python && IPOS_SOURCE=$source IPOS_PLANT_LIBRARY=$work/prefix/bin/ipos_plant.dll PIP_CONFIG_FILE=/dev/null \
  /usr/bin/python3 -m pip wheel . --no-build-isolation --no-deps --no-index -q -w "$work/wheel") || skip "no wheel: Debian's python3-pip, python3-wheel"
/usr/bin/python3 -m zipfile -e wheel/ipos-*-py3-none-win_amd64.whl unpacked
cmp unpacked/ipos/ipos_plant.dll prefix/bin/ipos_plant.dll
cp prefix/bin/client.exe unpacked/ipos
wine unpacked/ipos/client.exe "${plants[@]}" | tr -d '\r' | diff linux - || fail "the wheel's DLL does something else"
echo "$(stat -c %s prefix/bin/ipos_plant.dll) bytes; $(wc -l <exports) functions; needs $(paste -sd' ' imports); ${#plants[@]} plants and $(wc -l <linux) lines as on Linux"
