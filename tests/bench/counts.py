#!/usr/bin/env python3
"""Instructions of whole commands by callgrind: figures that do not depend on what else the machine does.

    counts.py IPOS [--store FILE] [--against FILE]

IPOS is built with -DIPOS_ASSERTS=OFF. The rows are those of docs/inside/performance.md: a program that ends at once, a small
test, the compilation of a long program (beside IPOS: tests/bench/ipos_bench_compile writes it), and a virtual millisecond of
plants, a run of four seconds less one of two. The dynamic linker's part stands apart.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile

import stored

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
EXAMPLES = os.path.join(ROOT, "examples")
ONE = "long r; main() { r = 1; }\n"
COUNT_PROGRAM = ("#include <constb.h>\n#include <iob.h>\nlong lNow, lBefore, lParts;\nmain() {\n  while (1) {\n    lNow = DI10;\n"
                 "    if (lNow && !lBefore) lParts = lParts + 1;\n    lBefore = lNow;\n  }\n}\n")
COUNT_PLANT = ('[[station]]\nname = "belt"\nunit = "mdxb"\nprogram = "COUNT.IPC"\n[station.parameters]\nP610 = "IPOS INPUT"\n')
COUNT_TEST = ('plant = "count.toml"\n[[step]]\nat = "100ms"\ninput = "DI10"\npulse = 1\nfor = "50ms"\n'
              '[[expect]]\nat = "500ms"\nvariable = "lParts"\nequals = 1\n')


def count(folder, *command):
    """Instructions of the command, and of them those of the dynamic linker before main()."""
    out = os.path.join(folder, "callgrind.out")
    run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", *command], cwd=folder,
                         stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    found = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or not found:
        sys.exit(f"{' '.join(command)}: status {run.returncode}\n{run.stderr[-2000:]}")
    shown = subprocess.run(["callgrind_annotate", "--inclusive=yes", out], stdout=subprocess.PIPE, text=True, check=True).stdout
    linker = re.search(r"^\s*([\d,]+) .*_dl_start\b", shown, re.MULTILINE)
    return int(found[1]), int(linker[1].replace(",", "")) if linker else 0


def main():
    options = argparse.ArgumentParser()
    options.add_argument("ipos")
    stored.add_options(options)
    args = options.parse_args()
    ipos = os.path.abspath(args.ipos)
    writer = os.path.join(os.path.dirname(os.path.dirname(ipos)), "tests/bench/ipos_bench_compile")
    whole, linker, of_plant = {}, {}, {}
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("one.IPC", ONE), ("COUNT.IPC", COUNT_PROGRAM), ("count.toml", COUNT_PLANT), ("count.test.toml", COUNT_TEST)):
            with open(os.path.join(folder, name), "w") as out:
                out.write(text)
        commands = {"run one.IPC": ["run", "one.IPC", "--until", "end"], "test of one plant": ["test", "."]}
        if os.path.exists(writer):
            with open(os.path.join(folder, "dense.IPC"), "w") as out:
                subprocess.run([writer, "--source"], stdout=out, check=True)
            commands["build dense.IPC"] = ["build", "dense.IPC", "-o", "dense.ipx"]
        for name, words in commands.items():
            whole[name], linker[name] = count(folder, ipos, *words)
        for name in ("scom", "hoist", "canopen", "profibus"):
            plant = os.path.join(EXAMPLES, name, name + ".toml")
            # Exit code 1 would be a fault of the plant; these have none.
            two, four = (count(folder, ipos, "run", plant, "--for", f"{seconds}s")[0] for seconds in (2, 4))
            of_plant[name] = round((four - two) / 2000)
    print("| command | million instructions | of it before main() |\n| --- | --- | --- |")
    for name in whole:
        print(f"| {name} | {whole[name] / 1e6:.1f} | {linker[name] / 1e6:.1f} |")
    print("\n| plant | instructions a virtual millisecond |\n| --- | --- |")
    for name, instructions in of_plant.items():
        print(f"| {name} | {instructions} |")
    stored.finish(args, "counts", {"commands": whole, "plants, a millisecond": of_plant}, 0.02)


if __name__ == "__main__":
    main()
