#!/usr/bin/env python3
"""Counts which of the typical mistakes (typical_mistakes_test.cpp) gcc and clang tell, with -Wall -Wextra, and holds the table
of docs/reference/diagnostics/comparison.md to it.

Each program becomes C: `long` is `int`, functions are `void f(void)` with prototypes, and a header made of the tables in
stdlib/ declares variables, structures and commands. A mistake counts as told when a warning or error stands within two lines of
it, whatever its words. Versions differ: others than those of the page are skipped.

beside_c.py ROOT [--list | --write]
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PEOPLE = {"Beginner": "beginners", "C": "people from C", "Plc": "people from PLC languages", "Expert": "experts of the drives"}
VERSIONS = {"gcc": "12.2", "clang": "14.0"}
FLAGS = ["-Wall", "-Wextra", "-Wno-unknown-pragmas", "-O1", "-S", "-o", "/dev/null"]
SKIPPED = 77
NEAR = 2
ROW = re.compile(r'\{"(\w+)", People::(\w+), (\d+), (nullptr|"(?:[^"\\]|\\.)*"), R"\((.*?)\)"(?:, "\w+")?\}', re.S)


def defs(path: Path, macro: str) -> list[list[str]]:
    """The texts in quotes of each row of a table."""
    rows = re.findall(rf"^{macro}\((.*)\)", path.read_text(), re.M)
    return [re.findall(r'"((?:[^"\\]|\\.)*)"', row) for row in rows]


def stub(root: Path) -> str:
    """What the tables of the language are in C."""
    out = ["int numof_(const void *);", "#define numof(x) numof_(&(x))", "extern int " + ", ".join(f"H{n}" for n in range(1024)) + ";"]
    for name, members, *_ in defs(root / "stdlib/structures.def", "STRUCTURE"):
        fields = "".join("int " + member.split("/")[0] + "; " for member in members.split())
        out.append(f"typedef struct {{ {fields}}} {name};")
    kinds = {"function": "void (*)(void)", "structure": "void *", "variable": "void *"}
    for name, _, arguments, *_ in defs(root / "stdlib/system_functions.def", "FUNCTION"):
        words = arguments.split()
        types = ", ".join(kinds.get(word, "int") for word in words) or "void"
        names = [f"a{n}" for n in range(len(words))]
        given = ", ".join(f"&({a})" if kinds.get(word) == "void *" else a for a, word in zip(names, words))
        if name == "_MoviLink":
            types, given = "MOVLNK *", "&(a0)"
        out.append(f"void {name}_({types});")
        # A command with arguments of the wrong number stays a function of that many, as a macro would tell it otherwise.
        out.append(f"#define {name}({', '.join(names)}) {name}_({given})")
    return "\n".join(out) + "\n"


def as_c(source: str) -> tuple[str, str]:
    """The program in C, line by line, and the prototypes of its functions."""
    prototypes = []

    def function(found: re.Match) -> str:
        name, given = found[1], found[2] or "void"
        body = source[found.end() : source.find("}", found.end())]
        result = "int" if name == "main" or re.search(r"\breturn\s+[^;]", body) else "void"
        if name != "main":
            prototypes.append(f"{result} {name}({given});\n")
        return f"{result} {name}({given}) {{"

    text = re.sub(r"(?:^|(?<=[;}] ))(main|\w+)\(([^(){};]*)\)\s*\{", function, source, flags=re.M)
    lines = []
    for number, line in enumerate(text.split("\n"), 1):
        # A line for each statement: what stands behind another one is not indented.
        lines.append(line if line.startswith("#") else line.replace("; ", f";\n#line {number}\n"))
    return "\n".join(lines), "".join(prototypes)


def told(compiler: str, root: Path, folder: Path, source: str, line: int) -> str | None:
    text, prototypes = as_c(source)
    (folder / "stub.h").write_text(stub(root) + "#define long int\n#define initial\n" + prototypes)
    (folder / "t.c").write_text(text)
    command = [compiler, "-I", str(root / "stdlib/include"), "-include", str(folder / "stub.h"), *FLAGS, "t.c"]
    result = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    # A message in a macro of a header belongs to the place that uses it.
    for found in re.finditer(r"^t\.c:(\d+):\d+: (warning|error|fatal error|note: in expansion of macro)\b(.*)$", result.stderr, re.M):
        if abs(int(found[1]) - line) <= NEAR:
            return found[2] + found[3]
    return None


def table(rows: list[tuple[str, bool, bool, bool]]) -> str:
    out = "| | mistakes | ipos | gcc | clang |\n| --- | --- | --- | --- | --- |\n"
    for people, name in [*PEOPLE.items(), (None, "all")]:
        own = [row for row in rows if people in (None, row[0])]
        out += f"| {name} | {len(own)} | " + " | ".join(str(sum(row[n] for row in own)) for n in (1, 2, 3)) + " |\n"
    return out


def main() -> int:
    root = Path(sys.argv[1]).resolve()
    option = sys.argv[2] if len(sys.argv) > 2 else ""
    for compiler, version in VERSIONS.items():
        try:
            found = subprocess.run([compiler, "--version"], capture_output=True, text=True).stdout
        except FileNotFoundError:
            found = ""
        if not re.search(rf"\b{re.escape(version)}\.", found):
            print(f"needs {compiler} {version}")
            return SKIPPED
    mistakes = ROW.findall((root / "tests/compiler/typical_mistakes_test.cpp").read_text())
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for name, people, line, words, source in mistakes:
            answers = {compiler: told(compiler, root, Path(folder), source, int(line)) for compiler in VERSIONS}
            rows.append((people, words != "nullptr", *(answer is not None for answer in answers.values())))
            if option == "--list":
                print(f"{people} {name}: " + "; ".join(f"{compiler}: {answer}" for compiler, answer in answers.items()))
    page = root / "docs/reference/diagnostics/comparison.md"
    text = page.read_text()
    first, last = "<!-- beside gcc and clang -->\n", "<!-- end -->\n"
    begin, end = text.index(first) + len(first), text.index(last)
    if option == "--write":
        page.write_text(text[:begin] + table(rows) + text[end:])
    elif text[begin:end] != table(rows):
        print(f"{page} has another table than this one, which --write writes:\n{table(rows)}")
        return 1
    print(f"{len(rows)} mistakes")
    return 0


sys.exit(main())
