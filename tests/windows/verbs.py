#!/usr/bin/env python3
"""Each verb on Windows does what it does on Linux: the same exit code, the same bytes on standard output, the same files, and on
standard error the same text. Prints the table verb x system.
usage: verbs.py IPOS.EXE IPOS [VERB...]     (IPOS: the program for Linux; 77: wine or ipos.exe are missing)"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
EXE, LINUX = (Path(word).resolve() for word in sys.argv[1:3])
PLANTS = sorted(str(p.relative_to(ROOT)) for p in ROOT.glob("examples/*/*.toml") if not p.name.endswith((".test.toml", ".campaign.toml")))
PLANTS = [p for p in PLANTS if "[[station]]" in (ROOT / p).read_text()]
PROGRAMS = sorted(str(p.relative_to(ROOT)) for p in ROOT.glob("examples/*/*.IPC"))


def missing() -> str:
    if not EXE.exists():
        return f"there is no {EXE}: ./dev windows builds it"
    if shutil.which("wine") is None:
        return "wine is not installed"
    return ""


class System:
    """A program, and a folder of its own for the files that it writes."""

    def __init__(self, command: list[str], environment: dict[str, str], work: Path):
        self.command, self.environment, self.work = command, environment, work
        work.mkdir()

    def run(self, words: list[str], text: bytes = b"") -> tuple[int, bytes, bytes]:
        words = [word.replace("{out}", str(self.work)) for word in words]
        done = subprocess.run([*self.command, *words], input=text, capture_output=True, cwd=ROOT, env=self.environment, timeout=300)
        # Windows' own files have its line ends; what ipos prints has none of them.
        return done.returncode, self.plain(done.stdout), self.plain(done.stderr)

    def plain(self, text: bytes) -> bytes:
        text = text.replace(str(self.work).encode(), b"{out}")
        # DAP names a file as its system does: Z:\\ is this machine's root under wine. A message's length follows its paths.
        text = re.sub(rb'"Z:((?:\\\\[^\\"]+)+)"', lambda path: b'"' + path[1].replace(rb"\\", b"/") + b'"', text)
        return re.sub(rb"Content-Length: \d+", b"Content-Length: N", text)

    def files(self) -> dict[str, bytes]:
        return {str(p.relative_to(self.work)): p.read_bytes() for p in sorted(self.work.rglob("*")) if p.is_file()}


def framed(*messages: dict) -> bytes:
    bodies = [json.dumps({"jsonrpc": "2.0", **m}).encode() for m in messages]
    return b"".join(b"Content-Length: %d\r\n\r\n%s" % (len(body), body) for body in bodies)


def lsp_session() -> bytes:
    text = (ROOT / "examples/hoist/HOIST.IPC").read_text() if (ROOT / "examples/hoist/HOIST.IPC").exists() else (ROOT / PROGRAMS[0]).read_text()
    uri = {"uri": "file:///C:/a%20line/MAIN.IPC"}
    at = {"line": 3, "character": 3}
    return framed(
        {"id": 1, "method": "initialize", "params": {"capabilities": {}}}, {"method": "initialized", "params": {}},
        {"method": "textDocument/didOpen", "params": {"textDocument": {**uri, "languageId": "ipos", "version": 1, "text": text}}},
        {"id": 2, "method": "textDocument/hover", "params": {"textDocument": uri, "position": at}},
        {"id": 3, "method": "textDocument/completion", "params": {"textDocument": uri, "position": at}},
        {"id": 4, "method": "textDocument/documentSymbol", "params": {"textDocument": uri}},
        {"id": 5, "method": "shutdown"}, {"method": "exit"})


def dap_session() -> bytes:
    def ask(seq: int, command: str, **arguments) -> dict:
        return {"seq": seq, "type": "request", "command": command, "arguments": arguments}
    return framed(ask(1, "initialize", adapterID="ipos"), ask(2, "launch", program="examples/scom/scom.toml", stopOnEntry=True),
                  ask(3, "configurationDone"), ask(4, "threads"), ask(5, "stepIn", threadId=2), ask(6, "stepIn", threadId=2),
                  ask(7, "stepBack", threadId=2), ask(8, "stackTrace", threadId=2), ask(9, "disconnect"))


DEBUG = b"""info tasks
until 300ms
print 1 + 1
step
step
reverse-step
reverse-stepi
info sbus
until 900ms
reverse-continue
backtrace
quit
"""


ASSEMBLER = subprocess.run([str(LINUX), "build", PROGRAMS[0], "--emit=asm"], cwd=ROOT, capture_output=True).stdout


def commands(verbs: list[str], subverbs: dict[str, list[str]]) -> dict[str, list]:
    """By verb: command lines, each with what it reads."""
    log, image = "{out}/can.log", "{out}/a.ipx"
    scom = "examples/scom/scom.toml"
    made: dict[str, list] = {verb: [[["help", verb]]] for verb in verbs}
    for verb, more in subverbs.items():
        made[verb] += [[[verb, sub, "--help"]] for sub in more]
    made["new"] += [[["new", "{out}/line"]], [["new", "{out}/hoist", "--from", "hoist"]], [["new", "{out}/line"]]]
    made["serve"] += [[["serve", "none.toml"]], [["serve", scom, "--device", "COM1"]]]
    made["run"] += [[["run", p, "--for", "2s", "--trace-hash"]] for p in PLANTS]
    made["run"] += [[["run", p, "--for", "1s", "--watch"]] for p in PLANTS]
    made["run"] += [[["run", scom, "--for", "1s", "--format", "json"]], [["run", scom, "--for", "1s", "--log", log]],
                    [["run", scom, "--for", "1s", "--log", "-", "--trace", "{out}/trace.csv", "--why"]],
                    [["run", "examples/hoist/hoist.toml", "--for", "3s", "--plot", "{out}/plot.svg"]]]
    made["test"] += [[["test", "examples/scom", "examples/hoist", "examples/tour"]], [["test", "none"]]]
    made["debug"] += [[["debug", p], DEBUG] for p in (scom, "examples/two-tasks/two-tasks.toml", PROGRAMS[0])]
    made["build"] += [[["build", p, "-o", f"{{out}}/{n}.ipx"]] for n, p in enumerate(PROGRAMS)]
    made["build"] += [[["build", PROGRAMS[0], f"--emit={form}"]] for form in ("tokens", "ast", "asm")]
    made["fmt"] += [[["fmt", "--diff", "examples"]], [["fmt", "-"], (ROOT / PROGRAMS[0]).read_bytes()]]
    made["explain"] += [[["explain", word]] for word in ("E0201", "P130", "H473", "_SBusCommDef", "F26", "brake", "no such word")]
    made["bus"] += [[["bus", "plan", p]] for p in PLANTS]
    made["bus"] += [[["run", scom, "--for", "500ms", "--log", log]], [["bus", "decode", log, "--names", scom]],
                    [["bus", "decode", log, "--format", "json"]], [["bus", "load", log, "--baud", "500000"]],
                    [["bus", "dbc", scom]], [["bus", "dissector", scom]], [["bus", "monitor", log, "--plant", scom]],
                    [["bus", "monitor", log, "--table"]], [["bus", "replay", log, scom]]]
    made["watch"] += [[["watch", scom, "unit1", "P000", "H420", "--once"]]]
    line = "examples/sbus-line/line.toml"
    made["param"] += [[["param", "list", line, "--station", "inverter1", "--long"]], [["param", "list", "--unit", "md60a", "--format", "json"]],
                      [["param", "get", line, "P130", "--station", "inverter1"]], [["param", "get", line, "P999", "--station", "inverter1"]],
                      [["param", "save", line, "{out}/unit.settings", "--station", "inverter1"]],
                      [["param", "diff", line, "{out}/unit.settings", "--station", "inverter2"]]]
    made["fms"] += [[["fms", "examples/profibus/profibus.toml", "belt", "read", "1025"]]]
    made["scan"] += [[["scan"]]]
    made["scope"] += [[["scope", "examples/hoist/hoist.toml", "--samples", "50", "-o", "-"]]]
    made["diag"] += [[["diag", p, station, "--at", "500ms"]] for p, station in ((scom, "unit1"), (line, "inverter1"))]
    made["canopen"] += [[["canopen", "eds", "--unit", "mdxb", "-o", "-"]]]
    made["profibus"] += [[["profibus", "gsd", kind]] for kind in ("ffp31", "size0", "dfp")]
    made["disasm"] += [[["build", PROGRAMS[0], "-o", image]], [["disasm", image]]]
    made["asm"] += [[["asm", "-", "-o", "{out}/b.ipx"], ASSEMBLER]]
    made["verify"] += [[["verify", image]], [["verify", scom]]]
    made["lsp"] += [[["lsp"], lsp_session()]]
    made["dap"] += [[["dap"], dap_session()]]
    made["completion"] += [[["completion", shell]] for shell in ("bash", "zsh", "fish", "cmd")]
    made["man"] += [[["man"]]]
    made["complete"] = [[["complete", *words]] for words in ([""], ["ru"], ["run", "examples/scom/"], ["explain", "P13"])]
    return made


# What no two runs have in common: how late the clock of this machine was.
def steady(text: bytes) -> bytes:
    return re.sub(rb"^ipos: (warning: )?real time: .*\n", b"", text, flags=re.M)


def wine_starts(environment: dict[str, str]) -> bool:
    """Starts wine's own services and lets them stay. Each has the standard error of the program that started it: where they came and
    went with a verb, a page fault of wine's ntoskrnl.exe as it ended stood among the verb's messages."""
    subprocess.run(["wineserver", "-p"], env=environment)
    first = subprocess.run([str(HERE / "ipos.sh"), "--version"], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return first.returncode == 0


def main() -> int:
    if why := missing():
        print(f"skipped: {why}")
        return 77
    environment = {**os.environ, "LC_ALL": "C.UTF-8", "IPOS_EXE": str(EXE)}
    environment.setdefault("WINEPREFIX", str(EXE.parent / "wine"))
    environment.pop("DISPLAY", None)
    Path(environment["WINEPREFIX"]).mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        linux = System([str(LINUX)], environment, Path(folder) / "linux")
        windows = System([str(HERE / "ipos.sh")], environment, Path(folder) / "windows")
        if not wine_starts(environment):
            print("skipped: wine does not start")
            return 77
        listed = re.findall(r"^  ([a-z]+) {2,}", linux.run(["--help"])[1].decode(), re.M)
        verbs = [*listed, "complete"]
        subverbs = {verb: re.findall(r"^  ([a-z]+) {2,}", linux.run([verb, "--help"])[1].decode().split("Subcommands:")[-1], re.M)
                    for verb in ("bus", "param", "canopen", "profibus")}
        all_commands = commands(verbs, subverbs)
        wrong = 0
        print(f"{'verb':<12}{'commands':>9}{'as on Linux':>13}")
        for verb in sys.argv[3:] or ["", *verbs]:
            lines = all_commands[verb] if verb else [[["--help"]], [[]], [["no-verb"]]]
            same = 0
            for line in lines:
                ours, theirs = linux.run(*line), windows.run(*line)
                differs = [name for name, a, b in zip(("exit code", "output", "messages"), ours, theirs)
                           if (a != b if name == "exit code" else steady(a) != steady(b))]
                ours_files, theirs_files = linux.files(), windows.files()
                differs += [f"file {name}" for name in sorted(set(ours_files) | set(theirs_files))
                            if linux.plain(ours_files.get(name, b"missing")) != windows.plain(theirs_files.get(name, b"missing"))]
                if not differs:
                    same += 1
                    continue
                print(f"  ipos {' '.join(line[0])}: not the same {', '.join(differs)}")
                for a, b in zip(ours[1:], theirs[1:]):
                    for x, y in [(x, y) for x, y in zip(a.split(b"\n"), b.split(b"\n")) if steady(x) != steady(y)][:3]:
                        print(f"    linux:   {x[:200]!r}\n    windows: {y[:200]!r}")
                    if len(a) != len(b):
                        print(f"    {len(a)} and {len(b)} bytes; windows ends with {b[-200:]!r}")
                wrong += 1
            print(f"{verb or '(none)':<12}{len(lines):>9}{same:>13}", flush=True)
    for way in ("-k", "-w"):  # ends them, and waits until they are gone
        subprocess.run(["wineserver", way], env=environment)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
