#!/usr/bin/env python3
"""How long the language server takes for a keystroke: a letter at a time in a plant of 64 stations, or in a program.

    keystroke.py IPOS [--stations 64] [--program FILE.IPC] [--keys 20]

Each key is a didChange, then completion at the cursor; what counts is the time until the answer and until the
diagnostics of the new text, and the processor time of the server. docs/inside/performance.md has the figures;
`ipos_bench_compile --source STATIONS` writes programs, 63 stations in 3037 lines.
"""
import argparse
import json
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

PROGRAM = "long lCount;\nmain()\n{\n  while (1) lCount++;\n}\n"


class Server:
    def __init__(self, ipos, folder):
        self.process = subprocess.Popen([ipos, "lsp"], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.id = 0
        self.request("initialize", {"rootUri": f"file://{folder}", "capabilities": {}})
        self.notify("initialized", {})

    def send(self, message):
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n" % len(body) + body)
        self.process.stdin.flush()

    def receive(self):
        length = 0
        while line := self.process.stdout.readline().strip():
            if line.startswith(b"Content-Length:"):
                length = int(line.split(b":")[1])
        return json.loads(self.process.stdout.read(length))

    def notify(self, method, params):
        self.send({"method": method, "params": params})

    def request(self, method, params):
        self.id += 1
        self.send({"id": self.id, "method": method, "params": params})
        while True:
            message = self.receive()
            if message.get("id") == self.id:
                return message.get("result")

    # Its diagnostics come before the answer where the program is whole, else behind it.
    def key(self, uri, version, line, column, letter):
        begin = time.monotonic()
        self.notify("textDocument/didChange", {"textDocument": {**uri, "version": version}, "contentChanges": [
            {"range": {"start": {"line": line, "character": column}, "end": {"line": line, "character": column}}, "text": letter}]})
        line, column = (line + 1, 0) if letter == "\n" else (line, column + 1)
        self.id += 1
        self.send({"id": self.id, "method": "textDocument/completion",
                   "params": {"textDocument": uri, "position": {"line": line, "character": column}}})
        answered, shown = 0, 0
        while not answered or not shown:
            message = self.receive()
            if message.get("id") == self.id:
                answered = time.monotonic() - begin
            if message.get("method") == "textDocument/publishDiagnostics":
                shown = time.monotonic() - begin
        return line, column, answered, shown

    def diagnostics(self):
        while True:
            message = self.receive()
            if message.get("method") == "textDocument/publishDiagnostics":
                return message["params"]["diagnostics"]

    def cpu(self):
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def write_plant(folder, stations):
    """The plant, and where to type: rows that are wrong until they are whole, and then make the plant anew."""
    text = '[[bus]]\nname = "sbus"\nkind = "can"\nbaud = 500000\n'
    for n in range(stations):
        (folder / f"P{n}.IPC").write_text(PROGRAM)
        text += (f'[[station]]\nname = "unit{n}"\nunit = "mdxb"\nprogram = "P{n}.IPC"\nsbus = "sbus"\n'
                 f'[station.parameters]\nP881 = {n}\nP130 = "2 s"\n')
    return "plant.toml", text, (text.count("\n"), 0), "P131 = 5\nP132 = 5\nP136 = 5\n"


def read_program(file):
    """The program, and where to type: behind a statement in its middle."""
    text = Path(file).read_text()
    lines = text.split("\n")
    line = next(n for n in range(len(lines) // 2, len(lines)) if lines[n].endswith(";"))
    return "program.IPC", text, (line, len(lines[line])), " lTarget1 = 12;"


def main():
    options = argparse.ArgumentParser()
    options.add_argument("ipos")
    options.add_argument("--stations", type=int, default=64)
    options.add_argument("--program")
    options.add_argument("--keys", type=int, default=20)
    asked = options.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        name, text, (line, column), typed = read_program(asked.program) if asked.program else write_plant(folder, asked.stations)
        path = folder / name
        path.write_text(text)
        uri = {"uri": f"file://{path}"}
        server = Server(asked.ipos, folder)
        server.notify("textDocument/didOpen", {"textDocument": {
            **uri, "languageId": "ipos" if asked.program else "toml", "version": 1, "text": text}})
        server.diagnostics()
        answers, shown, begin_cpu = [], [], server.cpu()
        for n in range(asked.keys):
            line, column, answer, diagnostics = server.key(uri, n + 2, line, column, typed[n % len(typed)])
            answers.append(answer)
            shown.append(diagnostics)
        used = (server.cpu() - begin_cpu) / asked.keys
        server.process.kill()
    for name, times in (("completion", answers), ("diagnostics", shown)):
        print(f"{name:12} median {1000 * statistics.median(times):7.1f} ms, longest {1000 * max(times):7.1f} ms")
    print(f"processor    {1000 * used:7.1f} ms a key")


if __name__ == "__main__":
    main()
