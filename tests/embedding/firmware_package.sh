#!/usr/bin/env bash
# The package for firmware as others take it: unpacked, with a program that `ipos build --emit=c` has made, compiled as C99 and
# run; its manifests name files that are there, versions that are the project's, and switches that exist. Zephyr's own
# functions are played by CMake's: Zephyr is not in Debian.
set -euo pipefail
. "$(dirname "$0")/folder.sh"
need python3
need ninja
cmake --build "$build" --target ipos_firmware_package >"$work/log" 2>&1 || fail "$(tail -n 20 "$work/log")"
version=$(sed -n 's/^project(ipos VERSION \([0-9.]*\).*/\1/p' "$source/CMakeLists.txt")
cd "$work"
python3 - "$build/ipos-firmware-$version.zip" "$build/ipos.ipos.$version.pack" "$version" <<'PY'
import json, os, re, sys, zipfile
import xml.etree.ElementTree as xml

archive, pack, version = sys.argv[1:]
with zipfile.ZipFile(archive) as a, zipfile.ZipFile(pack) as p:
    assert sorted(a.namelist()) == sorted(p.namelist())
    a.extractall("ipos")
library = json.load(open("ipos/library.json"))
assert (library["name"], library["version"]) == ("ipos", version), library
assert os.path.exists("ipos/" + library["headers"])
root = xml.parse("ipos/ipos.pdsc").getroot()
assert root.find("releases/release").get("version") == version
conditions = {row.get("id") for row in root.iter("condition")}
for component in root.iter("component"):
    assert component.get("Cversion") == version and component.get("condition") in conditions
names = [file.get("name") for file in root.iter("file")] + [root.find("license").text]
assert len(names) >= 4 and all(os.path.exists("ipos/" + name) for name in names), names
kconfig = set(re.findall(r"^config (\w+)|^menuconfig (\w+)", open("ipos/zephyr/Kconfig").read(), re.M))
offered = {a or b for a, b in kconfig}
used = set(re.findall(r"CONFIG_(\w+)", open("ipos/zephyr/CMakeLists.txt").read()))
assert offered == used, (offered, used)
source = open("ipos/ipos.c").read() + open("ipos/ipos.h").read()
assert all(f"#ifndef {name}\n" in source for name in offered - {"IPOS"}), offered
PY

cat >PROGRAM.IPC <<'IPC'
#include <const.h>
long kept, count, table[4];
other() { table[3] = 5; }
main() { count = 3; while (count) { count--; table[0] = table[0] + 7; } other(); kept = 1; while (1) { } }
IPC
"$build/tools/ipos" build PROGRAM.IPC --unit md60a --emit=c -o program.h
"$build/tools/ipos" build PROGRAM.IPC --unit md60a --emit=c | cmp - program.h
"$build/tools/ipos" build PROGRAM.IPC --unit md60a -o program.ipx
cat >main.c <<'C'
#include "ipos.h"
#include "program.h"
#include <stdio.h>

static uint64_t program_memory[IPOS_PROGRAM_BYTES / 8];
static uint64_t machine_memory[(IPOS_VM_BYTES + 7) / 8];

int main(void) {
  ipos_program* program;
  ipos_program_info info;
  ipos_vm* vm;
  int32_t sum = 0, last = 0;
  FILE* file = fopen("image.bin", "wb");
  if (file == NULL || fwrite(PROGRAM_image, 1, PROGRAM_image_size, file) != PROGRAM_image_size || fclose(file) != 0) return 1;
  if (ipos_program_load(program_memory, sizeof program_memory, PROGRAM_image, PROGRAM_image_size, &program, NULL) != IPOS_OK ||
      ipos_init(machine_memory, sizeof machine_memory, program, NULL, &vm) != IPOS_OK || ipos_start(vm) != IPOS_OK)
    return 2;
  ipos_program_info_of(program, &info);
  if (info.words != PROGRAM_WORDS || info.variables != PROGRAM_VARIABLES || IPOS_NV_VARIABLES != PROGRAM_KEPT_VARIABLES) return 3;
  if (PROGRAM_USES_TELEGRAMS || PROGRAM_USES_INTERRUPTS || PROGRAM_USES_MEMORY) return 4;
  if (ipos_start_task(vm, 2, PROGRAM_ENTRY_other) != IPOS_OK) return 5;
  ipos_run_ticks(vm, 100, NULL);
  ipos_read(vm, PROGRAM_H_table, &sum);
  ipos_read(vm, PROGRAM_H_table + 3, &last);
  return sum == 21 && last == 5 ? 0 : 6;
}
C
"$CC" -std=c99 -Wall -Wextra -pedantic -Werror -DIPOS_VARIABLES=512 -Iipos -I. ipos/ipos.c main.c -o program
./program || fail "the program for firmware ends with $?"
cmp image.bin program.ipx

mkdir zephyr
cat >zephyr/CMakeLists.txt <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(application C)
set(CONFIG_IPOS y)
set(CONFIG_IPOS_VARIABLES 512)
set(CONFIG_IPOS_PROGRAM_WORDS 2048)
set(CONFIG_IPOS_TELEGRAMS y)
set(CONFIG_IPOS_TEXTS y)
add_library(zephyr_interface INTERFACE)
macro(zephyr_include_directories)
  target_include_directories(zephyr_interface INTERFACE ${ARGN})
endmacro()
macro(zephyr_compile_definitions)
  target_compile_definitions(zephyr_interface INTERFACE ${ARGN})
endmacro()
macro(zephyr_library)
  add_library(module STATIC)
  target_link_libraries(module PUBLIC zephyr_interface)
endmacro()
macro(zephyr_library_sources)
  target_sources(module PRIVATE ${ARGN})
endmacro()
macro(zephyr_library_compile_definitions)
  target_compile_definitions(module PRIVATE ${ARGN})
endmacro()
add_subdirectory(../ipos/zephyr module)
add_executable(app ../main.c)
target_include_directories(app PRIVATE ..)
target_link_libraries(app module)
CMAKE
cmake -S zephyr -B zephyr/build >log 2>&1 && cmake --build zephyr/build >>log 2>&1 || fail "$(tail -n 20 log)"
zephyr/build/app || fail "as a module of Zephyr: $?"
