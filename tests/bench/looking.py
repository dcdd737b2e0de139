#!/usr/bin/env python3
"""What looking at a run costs: the plants of ipos_bench_plant, 64 drives on one SBus, run with and without traces in turn.

    looking.py IPOS [IPOS...] [--rounds 3] [--seconds 60] [--drives 64]

Prints the processor time of each run and its ratio to the run without a trace in the same round, the medians of all
rounds. Several programs are compared in turn as well. docs/inside/performance.md has the figures.
"""
import argparse
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent

HOW = {
    "nothing": [],
    "csv": ["--trace", "run.csv"],
    "vcd": ["--trace", "run.vcd"],
    "jsonl": ["--trace", "run.jsonl"],
    "packed": ["--trace", "run.ipos-trace"],
    "hash": ["--trace-hash"],
}


def pieces():
    """The programs of plant_bench.cpp: the texts between R"( and )"."""
    text = (HERE / "plant_bench.cpp").read_text()
    found = {}
    for part in text.split("constexpr const char* k")[1:]:
        name, rest = part.split(" = R\"(", 1)
        found[name] = rest.split(")\"", 1)[0]
    return found


ENABLED = "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n"
KINDS = {
    "busy": (["Tasks", "Turning"], "P130 = 500\nP160 = 1000000\n" + ENABLED),
    "travel": (["Tasks", "Travelling"], "P700 = 13\nP911 = 300\nP912 = 300\n" + ENABLED),
    "idle": (["Idle"], ""),
}


def make(folder, kind, drives):
    parts, (names, settings) = pieces(), KINDS[kind]
    plant = '[[bus]]\nname = "sbus"\nkind = "can"\nbaud = 1000000\n'
    for n in range(drives):
        objects = parts["Objects"].replace("{{", "{").replace("}}", "}")
        objects = objects.replace("{0}", str(1100 + n)).replace("{1}", str(1100 + (n + 1) % drives))
        (folder / f"P{n}.IPC").write_text(objects + "".join(parts[name] for name in names))
        plant += (f'[[station]]\nname = "unit{n}"\nunit = "mdxb"\nprogram = "P{n}.IPC"\nsbus = "sbus"\n'
                  f"[station.parameters]\nP881 = {n}\nP884 = 3\n{settings}")
    (folder / "plant.toml").write_text(plant)


def cpu_seconds(command, folder):
    child = subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(child.pid, 0)
    if status != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit status {status}")
    return used.ru_utime + used.ru_stime


def main():
    options = argparse.ArgumentParser()
    options.add_argument("ipos", nargs="+")
    options.add_argument("--rounds", type=int, default=3)
    options.add_argument("--seconds", type=int, default=60)
    options.add_argument("--drives", type=int, default=64)
    options.add_argument("--kinds", default=",".join(KINDS))
    options.add_argument("--how", default=",".join(HOW))
    asked = options.parse_args()
    for kind in asked.kinds.split(","):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            make(folder, kind, asked.drives)
            times = {}
            for _ in range(asked.rounds):
                for ipos in asked.ipos:
                    base = None
                    for how in asked.how.split(","):
                        command = [Path(ipos).resolve(), "run", "plant.toml", "--for", f"{asked.seconds}s", *HOW[how]]
                        used = cpu_seconds(command, folder)
                        base = base or used
                        times.setdefault((ipos, how), []).append((used, used / base))
            for (ipos, how), all_times in times.items():
                seconds = statistics.median(used for used, _ in all_times)
                ratio = statistics.median(ratio for _, ratio in all_times)
                print(f"{kind:7} {how:8} {seconds:8.3f} s {ratio:7.2f}  {ipos}", flush=True)


if __name__ == "__main__":
    main()
