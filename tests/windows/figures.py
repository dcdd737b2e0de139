#!/usr/bin/env python3
"""Figures of ipos.exe: its size, the DLLs that it needs, how long it takes to start, and its speed against the program for Linux, one
run after the other in turns. Started by hand.
usage: figures.py IPOS.EXE IPOS"""
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# What every Windows 10 has.
SYSTEM = {"advapi32", "bcrypt", "kernel32", "msvcrt", "mswsock", "ole32", "shell32", "user32", "winmm", "ws2_32", "setupapi"}
ROUNDS = 7


def seconds(command: list[str], environment: dict[str, str]) -> tuple[float, float]:
    """By the clock, and of the processor, which what runs beside it changes less."""
    begin, before = time.monotonic(), os.times()
    subprocess.run(command, cwd=ROOT, env=environment, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = os.times()
    return (time.monotonic() - begin,
            after.children_user + after.children_system - before.children_user - before.children_system)


def main() -> int:
    exe, linux = (Path(word).resolve() for word in sys.argv[1:3])
    environment = {**os.environ, "IPOS_EXE": str(exe)}
    environment.setdefault("WINEPREFIX", str(exe.parent / "wine"))
    with tempfile.TemporaryDirectory() as folder:
        stripped = Path(folder) / "ipos.exe"
        subprocess.run(["x86_64-w64-mingw32-strip", "-o", stripped, exe], check=True)
        print(f"size: {stripped.stat().st_size} bytes stripped")
    headers = subprocess.run(["x86_64-w64-mingw32-objdump", "-p", exe], capture_output=True, text=True).stdout
    dlls = sorted(name.lower() for name in re.findall(r"DLL Name: (\S+)\.dll", headers, re.I))
    print(f"DLLs: {', '.join(dlls)}; not of the system: {', '.join(sorted(set(dlls) - SYSTEM)) or 'none'}")
    words = {"start": ["--version"], "run": ["run", "examples/hoist/hoist.toml", "--for", "2000s", "--no-skip"]}
    programs = {"Linux": [str(linux)], "wine": [str(HERE / "ipos.sh")]}
    seconds([*programs["wine"], "--version"], environment)
    took: dict[tuple[str, str], list[tuple[float, float]]] = {(name, what): [] for name in programs for what in words}
    for _ in range(ROUNDS):
        for what, line in words.items():
            for name, program in programs.items():
                took[name, what].append(seconds([*program, *line], environment))
    for (name, what), all_of in took.items():
        print(f"{what} on {name}: least {min(all_of)[0] * 1000:.0f} ms, median {statistics.median(all_of)[0] * 1000:.0f} ms")
    of_processor = {key: min(processor for _, processor in all_of) for key, all_of in took.items()}
    run = {name: of_processor[name, "run"] - of_processor[name, "start"] for name in programs}
    print(f"speed: {run['wine'] / run['Linux']:.2f} x the processor time of Linux, without the start, the least of {ROUNDS} in turns")
    return 1 if set(dlls) - SYSTEM else 0


if __name__ == "__main__":
    sys.exit(main())
