#!/usr/bin/env python3
"""What a long campaign costs: time, cases a second and core, bytes of results, and memory on the way.

    tests/bench/campaign_price.py build/release/tools/ipos examples/campaign/line.campaign.toml /tmp/million --jobs 2
    tests/bench/campaign_price.py ... --shard 1/50        a fiftieth of the cases

All of examples/campaign is a million cases. A run that was stopped goes on, and then the figures are of what was left.
"""
import argparse
import os
import resource
import subprocess
import sys
import time
from pathlib import Path


def memory_of(root):
    """MB of each process below `root`, itself included, that is there now: the pages that it shares counted in parts."""
    parents = {}
    for entry in Path("/proc").glob("[0-9]*/stat"):
        try:
            parents[int(entry.parent.name)] = int(entry.read_text().rsplit(")", 1)[1].split()[1])
        except (OSError, IndexError):
            continue  # it is gone
    ours = {root}
    while more := {child for child, parent in parents.items() if parent in ours} - ours:
        ours |= more
    sizes = {}
    for process in ours:
        try:
            rows = Path(f"/proc/{process}/smaps_rollup").read_text().splitlines()
        except OSError:
            continue
        sizes[process] = sum(int(row.split()[1]) for row in rows if row.startswith("Pss:")) / 1024
    return sizes


def results(folder):
    files = list(folder.glob("shard-*.jsonl"))
    return sum(path.stat().st_size for path in files), files


def lines(files):
    return sum(path.read_bytes().count(b"\n") for path in files)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ipos")
    parser.add_argument("file")
    parser.add_argument("out", type=Path)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--shard", default="1/1")
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    bytes_before, files = results(options.out)
    cases_before = lines(files)

    begin = time.monotonic()
    run = subprocess.Popen([options.ipos, "campaign", "run", options.file, "--out", options.out, "--jobs", str(options.jobs),
                            "--shard", options.shard], stdout=subprocess.DEVNULL)
    memory = []  # time, MB of the largest process, MB of all
    while run.poll() is None:
        if sizes := memory_of(run.pid):
            memory.append((time.monotonic() - begin, max(sizes.values()), sum(sizes.values())))
        time.sleep(min(10, 0.5 + (time.monotonic() - begin) / 50))
    wall = time.monotonic() - begin
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = used.ru_utime + used.ru_stime

    bytes_after, files = results(options.out)
    cases = lines(files) - cases_before
    print(f"exit code {run.returncode}")
    print(f"cases     {cases}")
    print(f"time      {wall:.1f} s on the clock, {cpu:.1f} s of processors, {options.jobs} jobs")
    if cases == 0:
        return run.returncode
    print(f"a case    {1e3 * cpu / cases:.3f} ms of a processor: {cases / cpu:.0f} cases a second and core, {cases / wall:.0f} a second")
    print(f"results   {bytes_after - bytes_before} bytes, {(bytes_after - bytes_before) / cases:.0f} a case")
    for part, name in ((0.1, "a tenth"), (0.5, "half"), (0.95, "the end")):
        near = min(memory, key=lambda one: abs(one[0] - part * wall), default=None)
        if near:
            print(f"memory    {near[1]:.1f} MB the largest process, {near[2]:.1f} MB all together, near {name} of the time")
    print(f"memory    {used.ru_maxrss / 1024:.1f} MB at most of one process, shared pages included")
    return 0 if run.returncode in (0, 1) else run.returncode


if __name__ == "__main__":
    sys.exit(main())
