#!/usr/bin/env python3
"""Runs the benchmarks of this folder on every engine in turn and prints times relative to Lua 5.4, or to another one.

compare.py RUNNER [--rounds N] [--peers lua5.4,c] [--base c] [--store FILE] [--against FILE] [PROGRAM...]
RUNNER is ipos_bench_run. Every round runs every engine once, so that a change of the machine's speed meets all
of them; a cell is the median over the rounds of the ratios within a round. CPU time, the system's included (it
tells the two apart by samples, too coarse for runs of 20 ms), without what an empty program takes. All engines must
print the same number. --store keeps the cells, --against tells them beside a run that was kept (stored.py).
"""
import argparse
import math
import os
import statistics
import subprocess
import sys
import tempfile

import stored

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "programs")
NOISE = 0.1  # a cell of one machine comes again within it, mostly
ISSUE = ["sieve", "loops", "fib", "collatz", "state", "crc"]
EMPTY = {"IPC": "long result; main() { result = 0; }", "lua": "print(0)"}


def cpu_time(command):
    reader, writer = os.pipe()
    child = os.posix_spawnp(command[0], command, os.environ,
                            file_actions=[(os.POSIX_SPAWN_DUP2, writer, 1), (os.POSIX_SPAWN_OPEN, 2, "/dev/null", os.O_WRONLY, 0)])
    os.close(writer)
    with os.fdopen(reader) as out:
        text = out.read().strip()
    _, status, usage = os.wait4(child, 0)
    if status != 0:
        sys.exit(f"{' '.join(command)}: status {status}")
    return usage.ru_utime + usage.ru_stime, text


def main():
    options = argparse.ArgumentParser()
    options.add_argument("runner")
    options.add_argument("programs", nargs="*")
    options.add_argument("--rounds", type=int, default=5)
    options.add_argument("--peers", default="lua5.4,c")
    options.add_argument("--engines", default="reference,fast")
    options.add_argument("--base", default="lua5.4", help="the engine that the others are divided by")
    stored.add_options(options)
    args = options.parse_args()
    names = args.programs or ISSUE + sorted(f[:-4] for f in os.listdir(HERE) if f.endswith(".IPC") and f[:-4] not in ISSUE)
    engines = ["lua5.4"] + [p for p in args.peers.split(",") if p not in ("lua5.4", "")] + args.engines.split(",")

    with tempfile.TemporaryDirectory() as folder:
        for ending, text in EMPTY.items():
            with open(os.path.join(folder, "empty." + ending), "w") as out:
                out.write(text)
        with open(os.path.join(folder, "empty.c"), "w") as out:
            out.write('#include "bench.h"\nint main(void) { PRINT(0); }')

        def command(engine, name):
            base = os.path.join(folder if name == "empty" else HERE, name)
            if engine == "c":
                binary = os.path.join(folder, name + ".bin")
                if not os.path.exists(binary):
                    subprocess.run(["gcc", "-O2", "-fwrapv", "-I", HERE, base + ".c", "-o", binary], check=True)
                return [binary]
            if engine in args.engines.split(","):
                return [args.runner, "--engine", engine, base + ".IPC"]
            return [engine, base + ".lua"]

        start = {e: statistics.median(cpu_time(command(e, "empty"))[0] for _ in range(7)) for e in engines}
        ratios = {e: {n: [] for n in names} for e in engines}
        seconds = {e: {n: [] for n in names} for e in engines}
        for _ in range(args.rounds):
            for name in names:
                results = {}
                times = {}
                for engine in engines:
                    taken, results[engine] = cpu_time(command(engine, name))
                    times[engine] = max(taken - start[engine], 1e-6)
                if len(set(results.values())) != 1:
                    sys.exit(f"{name}: the results differ: {results}")
                for engine in engines:
                    seconds[engine][name].append(times[engine])
                    ratios[engine][name].append(times[engine] / times[args.base])

    def mean(engine, of):
        return math.exp(statistics.mean(math.log(statistics.median(ratios[engine][n])) for n in of))

    issue = [n for n in names if n in ISSUE]
    others = [n for n in names if n not in ISSUE]
    all_of_both = names if issue and others else []
    columns = issue + ["geomean"] * bool(issue) + others + ["geomean"] * bool(others) + ["all"] * bool(all_of_both)
    print("| engine | " + " | ".join(columns) + " |")
    print("| --- |" + " --- |" * len(columns))
    for engine in engines:
        cells = [f"{statistics.median(ratios[engine][n]):.3f}" for n in issue]
        cells += [f"**{mean(engine, issue):.3f}**"] if issue else []
        cells += [f"{statistics.median(ratios[engine][n]):.3f}" for n in others]
        cells += [f"**{mean(engine, others):.3f}**"] if others else []
        cells += [f"**{mean(engine, all_of_both):.3f}**"] if all_of_both else []
        print(f"| {engine} | " + " | ".join(cells) + " |")
    print("processor: " + stored.processor())
    print("seconds of lua5.4: " + ", ".join(f"{n} {statistics.median(seconds['lua5.4'][n]):.3f}" for n in names))
    cells = {e: {n: statistics.median(ratios[e][n]) for n in names} for e in engines if e != args.base}
    stored.finish(args, "compare", cells, NOISE)


main()
