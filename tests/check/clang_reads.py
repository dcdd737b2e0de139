#!/usr/bin/env python3
# Reads every source of a finished g++ build with clang++, its warnings being errors, without making code: so the
# presets `clang` and `fuzz` go on building without an hour to build them. `clang_reads.py build/dev [PART...]`: only
# sources whose path has one of the parts.
import json
import re
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from os import cpu_count
from pathlib import Path

GNU_ONLY = re.compile(r"-Wno-(restrict|maybe-uninitialized|array-bounds|stringop-\w+|dangling-pointer)$|-Winvalid-pch$"
                      r"|-falign-\S+$|-fno-(gcse|crossjumping|reorder-blocks-and-partition)$")


def words_of(command):
    """The command for clang, without output and precompiled headers."""
    words, out = iter(shlex.split(command)[1:]), ["clang++", "-fsyntax-only", "-Wno-unknown-warning-option"]
    for word in words:
        if word in ("-o", "-MT", "-MF"):
            next(words)
        elif word == "-include":
            header = next(words)
            if "cmake_pch" not in header:
                out += [word, header]
        elif word not in ("-MD", "-c") and not GNU_ONLY.match(word):
            out.append(word)
    return out


def main():
    build, parts = Path(sys.argv[1]).resolve(), sys.argv[2:]
    rows = {}
    for row in json.loads((build / "compile_commands.json").read_text()):
        own = not row["file"].startswith(str(build)) and "aarch64" not in row["command"].split()[0]
        if own and (not parts or any(part in row["file"] for part in parts)):
            rows.setdefault(row["file"], row)

    def read(row):
        done = subprocess.run(words_of(row["command"]), cwd=row["directory"], capture_output=True, text=True)
        if done.returncode != 0:
            print(done.stderr, end="", flush=True)
        return done.returncode

    with ThreadPoolExecutor(cpu_count()) as pool:
        failed = sum(code != 0 for code in pool.map(read, rows.values()))
    print(f"clang++ reads {len(rows) - failed} of {len(rows)} sources")
    return 1 if failed or not rows else 0


if __name__ == "__main__":
    sys.exit(main())
