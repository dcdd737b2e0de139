#!/usr/bin/env python3
"""Runs a program on a terminal of its own and prints what it wrote there.

usage: terminal.py KEYS PROGRAM ARGUMENT...     KEYS is typed bit by bit: each | waits for a prompt first
The prompt is `(ipos) `, or what TERMINAL_PROMPT says in the environment.
"""
import os
import pty
import select
import sys

PROMPT = os.environ.get("TERMINAL_PROMPT", "(ipos) ").encode()


def main(keys, command):
    child, terminal = pty.fork()
    if child == 0:
        os.execvp(command[0], command)
    parts = [part.encode().decode("unicode_escape").encode() for part in keys.split("|")[1:]]
    output, seen, quiet = b"", 0, 0
    while True:
        ready, _, _ = select.select([terminal], [], [], 1)
        quiet = 0 if ready else quiet + 1
        if not ready and quiet < 6:
            continue
        if not ready:
            output += b"\nterminal.py: nothing comes any more\n"
            os.kill(child, 9)
            break
        try:
            block = os.read(terminal, 4096)
        except OSError:  # the program has closed it
            break
        if not block:
            break
        output += block
        while parts and output.find(PROMPT, seen) >= 0:
            seen = output.find(PROMPT, seen) + len(PROMPT)
            os.write(terminal, parts.pop(0))
    sys.stdout.buffer.write(output.replace(b"\r\n", b"\n"))
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], sys.argv[2:]))
