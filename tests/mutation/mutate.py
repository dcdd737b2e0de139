#!/usr/bin/env python3
# Plants small mistakes in sources, one at a time, and asks the tests of the layer whether they notice; see README.md
# here. `mutate.py --sample 40 runtime/motion/ramp.cpp` prints what survives, with its line.
import argparse
import random
import re
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from layer import Layer  # noqa: E402
from mutants import Mutant, mutants  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]


def equivalents():
    """(file, line, mutated line) -> why no test can notice it."""
    rows = (Path(__file__).parent / "equivalents.tsv").read_text().splitlines()
    return {tuple(row.split("\t")[:3]): row.split("\t")[3] for row in rows if row and not row.startswith("#")}


def changed_lines(base):
    """file -> lines that differ from the commit."""
    text = subprocess.run(["git", "diff", "-U0", base, "--", "*.cpp"], cwd=ROOT, check=True, capture_output=True,
                          text=True).stdout
    lines, file = {}, None
    for row in text.splitlines():
        if row.startswith("+++ b/"):
            file = row[6:]
        elif hunk := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", row):
            first, count = int(hunk[1]), int(hunk[2] or 1)
            lines.setdefault(file, set()).update(range(first, first + count))
    return {f: l for f, l in lines.items() if f and not f.startswith("tests/")}


def replaced(text, line, old, new):
    """The one mutant that a person asks for."""
    first = sum(len(row) + 1 for row in text.split("\n")[: line - 1])
    at = text.find(old, first)
    if at < 0 or text.count("\n", first, at) != 0:
        raise SystemExit(f"mutate: line {line} has no '{old}'")
    return Mutant(at, at + len(old), new, line)


def judge(layer, place, text, mutant, known):
    """One of killed, same, equivalent, invalid, survived; and what says so."""
    before, after = mutant.lines(text)
    if (place, before, after) in known:
        return "equivalent", known[place, before, after]
    mutated = mutant.apply(text)
    built = layer.compile(mutated, "mutant")
    if built is None:
        return "invalid", ""
    if killer := layer.notices(built):
        return ("invalid" if killer == "(does not link)" else "killed"), killer
    return ("same", "") if layer.same_code(text, mutated) else ("survived", "")


def planted(source, chosen, options):
    """(place, text, mutants) of one source."""
    place = options.header or source
    text = (ROOT / place).read_text()
    if options.replace:
        line, old, new = options.replace
        return place, text, [replaced(text, int(line), old, new)]
    found = [m for m in mutants(text) if chosen is None or m.line in chosen]
    if options.lines:
        first, last = map(int, options.lines.split("-"))
        found = [m for m in found if first <= m.line <= last]
    return place, text, found


def drawn(name, found, options):
    """At most as many of the mutants of a source or folder as are asked for, in their order."""
    if not options.sample or options.sample >= len(found):
        return found
    chosen = random.Random(f"{options.seed} {name}").sample(range(len(found)), options.sample)
    return [found[n] for n in sorted(chosen)]


def built(file, build):
    """False for a source of another system, of which the build has nothing. Without a build all sources count."""
    commands = build / "compile_commands.json"
    return not commands.exists() or f'"{ROOT / file}"' in commands.read_text()


def score(name, counts):
    real = counts.get("killed", 0) + counts.get("survived", 0)
    if real:
        told = ", ".join(f"{n} {verdict}" for verdict, n in sorted(counts.items()))
        print(f"{name}: {100 * counts.get('killed', 0) // real} % noticed ({told})", flush=True)


def campaign(source, place, text, found, options):
    """Counts by verdict."""
    if options.list:
        for mutant in found:
            print(f"{place}:{mutant.line}: {' -> '.join(mutant.lines(text))}")
        return {}
    counts = {}
    known = equivalents()
    with tempfile.TemporaryDirectory(prefix="mutants-", dir=options.build) as work:
        layer = Layer(ROOT, options.build, source, Path(work), options.tests, options.header)
        layer.prepare(options.filter)
        for mutant in found:
            verdict, why = judge(layer, place, text, mutant, known)
            counts[verdict] = counts.get(verdict, 0) + 1
            if verdict == "survived" or options.verbose:
                before, after = mutant.lines(text)
                print(f"{place}:{mutant.line}: {verdict} {why}\n  - {before}\n  + {after}", flush=True)
    return counts


def main():
    parser = argparse.ArgumentParser(description="Plants small mistakes and says which ones no test of the layer notices.")
    parser.add_argument("sources", nargs="*", help="sources (.cpp) or folders of them, from the project root")
    parser.add_argument("--change", metavar="COMMIT", help="the lines that differ from this commit instead")
    parser.add_argument("--sample", type=int, help="at most this many mutants a file or folder, drawn by chance")
    parser.add_argument("--seed", default="1", help="of the draw")
    parser.add_argument("--lines", metavar="A-B", help="only these lines")
    parser.add_argument("--replace", nargs=3, metavar=("LINE", "OLD", "NEW"), help="this one mistake")
    parser.add_argument("--tests", nargs="+", metavar="NAME", help="these test programs instead of the layer's")
    parser.add_argument("--filter", metavar="TESTS", help="only these tests (a filter of GoogleTest)")
    parser.add_argument("--header", help="plant in this header or table instead, as the one source includes it")
    parser.add_argument("--build", type=Path, default=ROOT / "build/dev", help="a finished build (default build/dev)")
    parser.add_argument("--list", action="store_true", help="print the mutants, run nothing")
    parser.add_argument("--verbose", "-v", action="store_true", help="print every verdict")
    options = parser.parse_args()
    options.build = options.build.resolve()
    changed = changed_lines(options.change) if options.change else {}
    sources = {str((ROOT / s).resolve().relative_to(ROOT)): None for s in options.sources} | changed
    if not sources:
        parser.error("no source")
    survived = False
    for name, chosen in sources.items():
        folder = (ROOT / name).is_dir()
        files = [name]
        if folder:
            files = sorted(str(f.relative_to(ROOT)) for f in (ROOT / name).rglob("*.cpp"))
            files = [file for file in files if built(file, options.build)]
        found = {file: planted(file, chosen, options) for file in files}
        draw = drawn(options.header or name, [(file, m) for file in files for m in found[file][2]], options)
        total = {}
        for file in files:
            place, text, _ = found[file]
            if mine := [mutant for source, mutant in draw if source == file]:
                counts = campaign(file, place, text, mine, options)
                if not folder or options.verbose:
                    score(place, counts)
                for verdict, n in counts.items():
                    total[verdict] = total.get(verdict, 0) + n
        if folder:
            score(name, total)
        survived = survived or "survived" in total
    return 1 if survived else 0


if __name__ == "__main__":
    sys.exit(main())
