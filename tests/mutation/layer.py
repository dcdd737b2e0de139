# The tests of a source's layer: which programs they are (the table of tests/README.md), how the source is compiled
# and the programs are linked (as ninja does it), and how they are run. A mutant is compiled beside the build and
# linked in front of the libraries, so neither the sources nor the build are touched.
import json
import os
import re
import resource
import shlex
import shutil
import subprocess
import time
import xml.etree.ElementTree as xml
from pathlib import Path

MEMORY = 6 << 30  # a mutant that runs away stops here
COMPILE_SECONDS = 600


def programs_of(source, readme):
    """The ctest names of the rows whose folder is the nearest one above the source, or that name the file itself."""
    found = {}
    for row in re.findall(r"^\| ([^|]*`[^|]*) \| [^|]* \| ([^|]*) \|$", readme, re.M):
        folders = re.findall(r"`([^`]+)`", row[0])
        for folder in folders:
            for base in ["", *[str(p) + "/" for p in Path(folders[0]).parents]]:
                path = (base + folder).removeprefix("./")
                if source.startswith(path.rstrip("*")) and (path.endswith("*") or source[len(path)] in "/."):
                    found.setdefault(len(path), []).extend(re.findall(r"`(ipos_\w+)`", row[1]))
    return list(dict.fromkeys(found[max(found)])) if found else []


def quick_linker():
    """mold or lld link in a quarter of the time, where the machine has one."""
    return next(([f"-fuse-ld={name}"] for name in ("mold", "lld") if shutil.which(f"ld.{name}")), [])


def object_of(command):
    return re.search(r" -o (\S+)", command)[1]


class Program:
    """One GoogleTest program, and what a run of it says."""

    def __init__(self, build, work, cache, source, test):
        self.name = test["name"]
        self.build = build
        self.work = work
        self.source = source
        self.cache = cache
        self.arguments = [a for a in test["command"][1:] if not a.startswith("--gtest_output")]
        properties = {p["name"]: p["value"] for p in test.get("properties", [])}
        self.folder = properties.get("WORKING_DIRECTORY", str(build))
        self.binary = Path(test["command"][0])
        relative = os.path.relpath(self.binary, build)
        commands = subprocess.run(["ninja", "-C", str(build), "-t", "commands", relative], check=True,
                                  capture_output=True, text=True).stdout.strip().splitlines()
        self.link = re.sub(r"^: && | && :$", "", commands[-1])
        self.tool = None  # the `ipos` with the mutant, for tests that run it
        self.only = None  # a filter of GoogleTest, instead of all tests
        self.only_seconds = 0.0
        self.seconds = {}
        self.killers = []

    def measure(self):
        """True when the tests had to be run for it."""
        report = self.cache / f"{self.name}.xml"
        missing = not report.exists() or report.stat().st_mtime < self.binary.stat().st_mtime
        if missing:
            if not self.run(self.binary, [f"--gtest_output=xml:{report}"], 1800):
                report.unlink(missing_ok=True)
                raise SystemExit(f"mutate: {self.name} fails without a mutant")
        for case in xml.parse(report).iter("testcase"):
            if case.get("status") == "run":
                self.seconds[f"{case.get('classname')}.{case.get('name')}"] = float(case.get("time"))
        return missing

    def restrict(self, only):
        """From now on only the tests of a filter, which run once without a mutant for their time."""
        began = time.monotonic()
        if not self.run(self.binary, ["--gtest_brief=1", f"--gtest_filter={only}"], 1800):
            raise SystemExit(f"mutate: {self.name} fails without a mutant")
        self.only, self.only_seconds = only, time.monotonic() - began

    def passes(self):
        """The tests, most promising first: what has noticed a mutant before, then what is quick, then the rest."""
        total = sum(self.seconds.values())
        quick, spent = [], 0.0
        for name in sorted(self.seconds, key=self.seconds.get):
            spent += self.seconds[name]
            if spent > max(1.0, total / 10):
                break
            quick.append(name)
        before = [name for name in self.killers if self.seconds[name] < max(1.0, total / 20)][-20:]
        rest = [name for name in self.seconds if name not in set(quick)]
        return [names for names in (before, quick, rest) if names]

    def run(self, binary, arguments, seconds):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        (self.work / "tmp").mkdir(exist_ok=True)
        environment = dict(os.environ, TMPDIR=str(self.work / "tmp"))
        if self.tool:
            environment["IPOS_PROGRAM"] = str(self.tool)
        with subprocess.Popen([str(binary), *self.arguments, *arguments], cwd=self.folder, env=environment,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              start_new_session=True, preexec_fn=limit) as process:
            try:
                self.output = process.communicate(timeout=seconds)[0].decode(errors="replace")
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, 9)
                process.communicate()
                self.output = "[  FAILED  ] (no end)"
                return False
        return process.returncode in (0, 77)

    def holds(self, original, library):
        """The program has the source in it: as its own, in a library, or as one object of a library."""
        return self.name == library or f"lib{library}.a" in self.link or original in self.link.split()

    def linked(self, mutant, original, options):
        """The program with the mutant instead of the original object, or None. `options`: what it wants for linking."""
        binary = self.work / self.name
        # Where a program compiles the layer itself, or takes the objects of a library one by one.
        own = re.compile(rf"\S*/{re.escape(self.source)}\.o\b|(?<!\S){re.escape(original)}(?!\S)")
        link = re.sub(r" -o \S+ ", lambda m: f" {shlex.join([*options, str(mutant)])} -o {shlex.quote(str(binary))} ",
                      own.sub("", self.link), count=1)
        done = subprocess.run(link, shell=True, cwd=self.build, capture_output=True, text=True)
        return binary if done.returncode == 0 else None

    def notices(self, binary, tool):
        """The name of a test of the program that fails, or None; its tests run `tool` where there is one."""
        self.tool = tool
        for names in [[self.only]] if self.only else self.passes():
            limit = 15 + 8 * (self.only_seconds if self.only else sum(self.seconds[name] for name in names))
            if self.run(binary, ["--gtest_fail_fast", "--gtest_brief=1", "--gtest_filter=" + ":".join(names)], limit):
                continue
            failed = re.search(r"\[  FAILED  \] (\w\S*?),?\s", self.output + " ")
            name = failed[1] if failed else "(no end)" if "(no end)" in self.output else "(crash)"
            if name in self.seconds:
                self.killers = [k for k in self.killers if k != name] + [name]
            return name
        shutil.rmtree(self.work / "tmp", ignore_errors=True)
        return None


class Layer:
    def __init__(self, root, build, source, work, names=None, header=None):
        self.header = header
        cache = build / "mutation"  # how long each test takes
        cache.mkdir(exist_ok=True)
        self.root, self.build, self.source, self.work = root, build, source, work
        names = names or programs_of(source, (root / "tests/README.md").read_text())
        listed = json.loads(subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, check=True,
                                           capture_output=True, text=True).stdout)
        tests = {t["name"]: t for t in listed["tests"] if t.get("command")}
        self.programs = [Program(build, work, cache, source, tests[n]) for n in names
                         if n in tests and Path(tests[n]["command"][0]).name == n]
        if not self.programs:
            raise SystemExit(f"mutate: no test program of {source}; has {build} been built?")
        # Most tests of tools run the program `ipos`, some link a library of it.
        tool = build / "tools/ipos"
        self.tool = None
        if source.startswith("tools/") and tool.exists():
            self.tool = Program(build, work, cache, source, {"name": "ipos", "command": [str(tool)]})
        self.command, library = self.compile_command()
        self.original = object_of(self.command)
        # Another library may compile the same source with other options; the mutant does not fit into its programs.
        if self.tool and not self.tool.holds(self.original, library):
            self.tool = None
        self.linking = [p for p in self.programs if p.holds(self.original, library)]
        if not self.tool:
            self.programs = self.linking
        if not self.programs:  # else all mutants would survive
            raise SystemExit(f"mutate: no test program of {source} links {self.original}")
        # A mutant compiled with a sanitizer needs it in every program, also in those that have none themselves.
        self.link_options = re.findall(r"-fsanitize=\S+", self.command) + quick_linker()

    def prepare(self, only=None):
        for program in self.programs:
            if only:
                program.restrict(only)
            elif program.measure():
                print(f"{program.name}: {len(program.seconds)} tests, {sum(program.seconds.values()):.1f} s", flush=True)

    def notices(self, mutant):
        """What fails with the mutant, as program and test, or None."""
        tool = self.tool and self.tool.linked(mutant, self.original, self.link_options)
        if self.tool and not tool:
            return "(does not link)"
        for program in self.programs:
            binary = program.binary
            if program in self.linking:
                binary = program.linked(mutant, self.original, self.link_options)
            if not binary:
                return "(does not link)"
            if killer := program.notices(binary, tool):
                return f"{program.name} {killer}"
        return None

    def compile_command(self):
        """Of the first library that one of the programs links, or of a program itself; and its name."""
        rows = [row["command"] for row in json.loads((self.build / "compile_commands.json").read_text())
                if Path(row["file"]) == self.root / self.source]
        for program in [*self.programs, *([self.tool] if self.tool else [])]:
            for command in rows:
                library = re.search(r" -o \S*CMakeFiles/(\w+)\.dir/", command)
                if program.holds(object_of(command), library[1]):
                    return command, library[1]
        raise SystemExit(f"mutate: {self.source} is in no library of {', '.join(p.name for p in self.programs)}")

    def compile(self, text, name, *options):
        """The object, or None. `text` is the source's, or that of the header which only this source then sees; at -O0
        its inline functions are everybody's, as the linker takes the first of equal ones."""
        folder = self.work / name
        source = folder / Path(self.source).name
        planted = folder / self.header if self.header else source
        planted.parent.mkdir(parents=True, exist_ok=True)
        if self.header:
            source.write_text((self.root / self.source).read_text())
        planted.write_text(text)
        words = shlex.split(self.command)
        words = words[: words.index("-MD")] if "-MD" in words else words[: words.index("-o")]
        words += ["-w", "-g0", "-iquote", str(folder), "-iquote", str((self.root / self.source).parent), *options]
        done = subprocess.run([*words, "-o", str(folder / "it.o"), "-c", source.name], cwd=folder,
                              capture_output=True, text=True, timeout=COMPILE_SECONDS)
        return folder / "it.o" if done.returncode == 0 else None

    def same_code(self, original, mutated):
        """The compiler makes the same of both: no test can tell them apart."""
        options = ("-O2", "-g0", "-DNDEBUG", "-U_GLIBCXX_ASSERTIONS")
        first = self.work / "original" / "it.o"
        if not first.exists():
            self.compile(original, "original", *options)
        second = self.compile(mutated, "same", *options)
        return second is not None and first.exists() and first.read_bytes() == second.read_bytes()
