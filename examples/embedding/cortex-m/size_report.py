#!/usr/bin/env python3
"""Sizes of the library in a Cortex-M build, as a table by parts: flash, RAM, deepest stack.

    size_report.py BUILD_DIR [--flash BYTES] [--ram BYTES]

Reads the map of the program `whole`, which contains all of ipos.h, and the call graphs of gcc (-fcallgraph-info=su).
With limits it fails when the library is larger. RAM is a machine without its variables, and a program."""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

SECTION = re.compile(r"^ (\.\S+)(?:\n\s+|\s+)0x[0-9a-f]+\s+0x([0-9a-f]+) (\S+)$", re.M)
PART = re.compile(r"^/\* ==== (\w+)", re.M)
DEFINITION = re.compile(r"^(?:static )?(?:const )?[\w* ]+?\b(\w+)(?:\(|\[)|^\} (k\w+)\[", re.M)


def parts_of(source):
    """By the name of a function or table of ipos.c the part that defines it."""
    text = source.read_text()
    marks = [(mark.start(), mark[1]) for mark in PART.finditer(text)]
    parts = {}
    for found in DEFINITION.finditer(text):
        before = [name for at, name in marks if at < found.start()]
        if before:
            parts[found[1] or found[2]] = before[-1]  # the definition stands behind what only names it
    return parts


def module_sizes(map_file, parts):
    text = map_file.read_text()
    text = text[text.index("Linker script and memory map"):]
    sizes = collections.defaultdict(lambda: [0, 0, 0])
    for section, size, path in SECTION.findall(text):
        words = section.split(".")
        column = {"text": 0, "rodata": 0, "data": 1, "bss": 2}.get(words[1])
        if column is None or int(size, 16) == 0:
            continue
        library = re.search(r"(libipos\.a|libc\.a|libgcc\.a)\(", path)
        if library:
            owner = words[2] if len(words) > 2 else ""
            name = parts.get(owner, "texts and tables of switches") if library[1] == "libipos.a" else library[1]
            sizes[name][column] += int(size, 16)
    return sizes


def deepest_stacks(folder):
    """Stack of each function and all it calls; callbacks of the host are not in it."""
    own, calls = {}, collections.defaultdict(set)
    for graph in folder.rglob("*.ci"):
        text = graph.read_text()
        for title, label in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]+)"', text):
            size = re.search(r"(\d+) bytes \((static|dynamic)", label)
            if size:
                own[title] = max(own.get(title, 0), int(size[1]))
        for source, target in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', text):
            calls[source].add(target)
    depth = {}

    def walk(name, path):
        if name not in depth:
            if name in path:
                return own.get(name, 0)  # a cycle by way of the host: counted once
            depth[name] = own.get(name, 0) + max((walk(next_, path | {name}) for next_ in calls[name]), default=0)
        return depth[name]

    return {name: walk(name, frozenset()) for name in list(own) if name.startswith("ipos_")}


def object_sizes(library):
    """sizeof of the two objects, out of the code that returns them."""
    out = {}
    text = subprocess.run(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", str(library)], capture_output=True,
                          text=True, check=True).stdout
    for name in ("ipos_program_size", "ipos_vm_size"):
        size = 0
        for what, operands in re.findall(r"^ +[0-9a-f]+:\t(\S+)(.*)$", text[text.index(f"<{name}>:"):][:400], re.M):
            number = re.search(r"(?:#|0x)([0-9a-f]+)", operands)
            if what == ".word":
                size = int(number[1], 16)
            elif what.startswith("mov"):
                size = int(number[1])
            elif what.startswith("lsl"):
                size <<= int(number[1])
            elif what.startswith("add"):
                size += int(number[1])
            elif what == "bx" and size != 0:
                break
        out[name] = size
    return out


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("build", type=pathlib.Path)
    arguments.add_argument("--flash", type=int)
    arguments.add_argument("--ram", type=int)
    options = arguments.parse_args()
    sizes = module_sizes(next(options.build.rglob("whole.map")), parts_of(options.build / "firmware/ipos.c"))
    print(f"{'part':28} {'text':>7} {'data':>6} {'bss':>6}")
    for name, row in sorted(sizes.items(), key=lambda item: -item[1][0]):
        print(f"{name:28} {row[0]:7} {row[1]:6} {row[2]:6}")
    flash = sum(row[0] + row[1] for row in sizes.values())
    static = sum(row[1] + row[2] for row in sizes.values())
    print(f"{'all':28} {flash:7}\n")

    objects = object_sizes(next(options.build.rglob("libipos.a")))
    cache = (options.build / "CMakeCache.txt").read_text()
    variables = int(re.search(r"IPOS_VARIABLES:\w+=(\d+)", cache)[1])
    machine = objects["ipos_vm_size"] - 4 * variables
    stacks = deepest_stacks(options.build)
    for name, size in sorted(stacks.items(), key=lambda item: -item[1])[:8]:
        print(f"stack of {name:22} {size:6}")
    ram = static + machine + objects["ipos_program_size"]
    print(f"\nRAM of a machine without its {variables} variables: {machine}, of a program: "
          f"{objects['ipos_program_size']}, static: {static}, together {ram} bytes")
    bad = [f"{what} {is_} bytes, at most {limit} are allowed"
           for what, is_, limit in (("flash", flash, options.flash), ("RAM", ram, options.ram)) if limit and is_ > limit]
    for line in bad:
        print(line, file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
