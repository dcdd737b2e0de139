#!/usr/bin/env python3
"""How long the language server takes for a keystroke: a plant of 64 stations, a letter at a time.

    keystroke.py IPOS [--stations 64] [--keys 20]

Each key is a didChange, then completion at the cursor; what counts is the time until the answer and until the
diagnostics of the new text, and the processor time of the server. docs/inside/performance.md has the figures.
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

    def diagnostics(self):
        while True:
            message = self.receive()
            if message.get("method") == "textDocument/publishDiagnostics":
                return message["params"]["diagnostics"]

    def cpu(self):
        fields = Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    options = argparse.ArgumentParser()
    options.add_argument("ipos")
    options.add_argument("--stations", type=int, default=64)
    options.add_argument("--keys", type=int, default=20)
    asked = options.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        text = '[[bus]]\nname = "sbus"\nkind = "can"\nbaud = 500000\n'
        for n in range(asked.stations):
            (Path(folder) / f"P{n}.IPC").write_text(PROGRAM)
            text += (f'[[station]]\nname = "unit{n}"\nunit = "mdxb"\nprogram = "P{n}.IPC"\nsbus = "sbus"\n'
                     f'[station.parameters]\nP881 = {n}\nP130 = "2 s"\n')
        path = Path(folder) / "plant.toml"
        path.write_text(text)
        uri = {"uri": f"file://{path}"}
        server = Server(asked.ipos, folder)
        server.notify("textDocument/didOpen", {"textDocument": {**uri, "languageId": "toml", "version": 1, "text": text}})
        server.diagnostics()
        line, column = text.count("\n"), 0
        answers, shown, begin_cpu = [], [], server.cpu()
        # Rows that are wrong until they are whole, and then make the plant anew.
        for n, letter in enumerate(("P131 = 5\nP132 = 5\nP136 = 5\n" * asked.keys)[: asked.keys]):
            begin = time.monotonic()
            at = {"line": line, "character": column}
            server.notify("textDocument/didChange", {"textDocument": {**uri, "version": n + 2}, "contentChanges": [
                {"range": {"start": at, "end": at}, "text": letter}]})
            line, column = (line + 1, 0) if letter == "\n" else (line, column + 1)
            server.request("textDocument/completion", {"textDocument": uri, "position": {"line": line, "character": column}})
            answers.append(time.monotonic() - begin)
            server.diagnostics()
            shown.append(time.monotonic() - begin)
        used = (server.cpu() - begin_cpu) / asked.keys
        server.process.kill()
    for name, times in (("completion", answers), ("diagnostics", shown)):
        print(f"{name:12} median {1000 * statistics.median(times):7.1f} ms, longest {1000 * max(times):7.1f} ms")
    print(f"processor    {1000 * used:7.1f} ms a key")


if __name__ == "__main__":
    main()
