#!/usr/bin/env python3
"""Follows a page of the guide word for word and compares what the commands print.

usage: follow.py PAGE IPOS [--root DIR]     (IPOS: the program; it is found as `ipos` by the commands of the page)

With --root the commands run in that root file system, by chroot, with IPOS as its /usr/local/bin/ipos.

Of the page it reads blocks with ```sh, in which "$ " begins a command, in one shell after the other; a block below
"<!-- write FILE -->" is the content of FILE, one below "<!-- change FILE -->" a diff without line numbers for it.
Prints each difference and how many commands were run; exit 1 on a difference.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile


def blocks(page):
    """(note, language, text) of each fenced block; the note is the comment right above it."""
    pattern = r"(?:<!-- (\w+ \S+) -->\n)?```(\w*)\n(.*?)^```$"
    return re.findall(pattern, page, re.DOTALL | re.MULTILINE)


def commands(text):
    """(command, what it prints) of a block."""
    found = []
    for line in text.splitlines(keepends=True):
        if line.startswith("$ "):
            found.append([line[2:].rstrip("\n"), ""])
        else:
            found[-1][1] += line
    return found


def changed(old, diff):
    """The text with the diff's parts replaced, each exactly once. What stands behind // may be laid out otherwise."""
    for part in re.split(r"^@@.*\n", diff, flags=re.MULTILINE):
        lines = part.splitlines()
        before = [line[1:] for line in lines if line[:1] in (" ", "-", "")]
        after = [line[1:] for line in lines if line[:1] in (" ", "+", "")]
        squeeze = lambda line: re.sub(r"\s+//", " //", line.rstrip())
        have = old.split("\n")
        places = [n for n in range(len(have))
                  if [squeeze(line) for line in have[n:n + len(before)]] == [squeeze(line) for line in before]]
        if len(places) != 1:
            raise SystemExit(f"a part of the diff fits {len(places)} times:\n{part}")
        have[places[0]:places[0] + len(before)] = after
        old = "\n".join(have)
    return old


def main(page_name, program, root=""):
    with open(page_name, encoding="utf-8") as file:
        page = file.read()
    count = differences = 0
    with tempfile.TemporaryDirectory(dir=root + "/tmp" if root else None) as top:
        bin_folder = root + "/usr/local/bin" if root else os.path.join(top, "bin")
        if root:
            shutil.copy(program, os.path.join(bin_folder, "ipos"))
            environment = {"PATH": "/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin", "HOME": "/root"}
        else:
            os.mkdir(bin_folder)
            os.symlink(os.path.abspath(program), os.path.join(bin_folder, "ipos"))
            environment = dict(os.environ, PATH=bin_folder + ":" + os.environ["PATH"])
        here = os.path.join(top, "work")
        os.mkdir(here)
        for note, language, text in blocks(page):
            if note:
                what, name = note.split()
                path = os.path.join(here, name)
                if what == "change":
                    with open(path, encoding="utf-8") as file:
                        text = changed(file.read(), text)
                with open(path, "w", encoding="utf-8") as file:
                    file.write(text)
            elif language == "sh":
                for command, expected in commands(text):
                    if command.startswith("cd "):
                        here = os.path.join(here, command[3:])
                        continue
                    words = ["bash", "-c", command]
                    if root:
                        words = ["chroot", root, "bash", "-c", 'cd "$1" && eval "$2"', "bash", here[len(root):], command]
                    run = subprocess.run(words, cwd=None if root else here, env=environment, text=True,
                                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
                    count += 1
                    if run.stdout != expected:
                        differences += 1
                        print(f"$ {command}\n--- the page\n{expected}--- the program\n{run.stdout}")
    print(f"{count} commands, {differences} differences")
    return 1 if differences or count == 0 else 0


if __name__ == "__main__":
    if len(sys.argv) not in (3, 5) or sys.argv[3:4] not in ([], ["--root"]):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], *sys.argv[4:]))
