"""A run of a bench kept as JSON, and what a later run says beside it: compare.py and counts.py store and compare with this.

The processor's name is part of what is kept. Ratios and counts of one processor say little about another one's, so a
comparison across two of them says so.
"""
import json
import math
import os
import platform
import statistics


def processor():
    """As the system names it, with family and model: some names say no more than "Processor"."""
    row = {}
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo") as info:
            for line in info:
                if not line.strip():
                    break
                key, _, value = line.partition(":")
                row[key.strip()] = value.strip()
    if "model name" not in row:
        return platform.processor() or platform.machine()
    return f"{row['model name']}, family {row.get('cpu family', '?')}, model {row.get('model', '?')}"


def add_options(options):
    options.add_argument("--store", metavar="FILE", help="keep the figures of this run as JSON")
    options.add_argument("--against", metavar="FILE", help="compare with a run that was kept")


def finish(args, kind, figures, noise):
    """`figures`: rows of cells, each a number, as {row: {column: number}}. `noise`: a change within it says nothing."""
    if args.store:
        with open(args.store, "w") as out:
            json.dump({"kind": kind, "processor": processor(), "figures": figures}, out, indent=1, sort_keys=True)
            out.write("\n")
    if args.against:
        with open(args.against) as kept:
            then = json.load(kept)
        print("\n".join(compared(kind, figures, then, processor(), noise)))


def compared(kind, figures, then, now_processor, noise):
    """The lines of a comparison: now divided by then."""
    if then.get("kind") != kind:
        return [f"the kept run is of {then.get('kind')}, this one of {kind}: nothing to compare"]
    lines = []
    if then["processor"] != now_processor:
        lines.append(f"the kept run is of another processor ({then['processor']}), this is {now_processor}: "
                     "differences may be the processor's")
    for row, cells in figures.items():
        before = then["figures"].get(row, {})
        changes = {name: cells[name] / before[name] for name in cells if before.get(name)}
        if not changes:
            lines.append(f"{row}: not in the kept run")
            continue
        mean = math.exp(statistics.mean(math.log(change) for change in changes.values()))
        told = [f"{name} {change:.2f}" for name, change in changes.items() if abs(change - 1) > noise]
        lines.append(f"{row}: {mean:.3f} of the kept run" + (", outside of the noise: " + ", ".join(told) if told else ""))
    return lines
