#!/usr/bin/env python3
"""The syntax of vim gives the words of a source the colours of their kinds. Usage: vim_test.py FOLDER_OF_THE_PLUGIN"""
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = """#include <const.h>
// a TODO
long lSpeed;
main()
{
  if (H10 == 0x1F) _Wait(5);
  goto x; /* y */
}
"""
# Line and column from 1, and the group there.
WANTED = {
    (1, 2): "iposDirective", (1, 12): "iposIncluded", (2, 1): "iposComment", (2, 6): "iposTodo",
    (3, 1): "iposType", (3, 6): "", (6, 3): "iposControl", (6, 7): "iposVariable", (6, 14): "iposNumber",
    (6, 20): "iposSystemFunction", (7, 3): "iposForeign", (7, 12): "iposComment",
}


def main():
    vim = shutil.which("vim") or shutil.which("nvim")
    if vim is None:
        print("skipped: there is no vim here")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        source, out = Path(folder) / "A.IPC", Path(folder) / "out"
        source.write_text(SOURCE)
        places = "[" + ",".join(f"[{line},{column}]" for line, column in WANTED) + "]"
        subprocess.run(
            [vim, "-es", "-u", "NONE", "-i", "NONE", "-N", "--cmd", f"set rtp^={sys.argv[1]}", "-c", "filetype on",
             "-c", "syntax on", "-c", f"edit {source}",
             "-c", f"call writefile(map({places}, 'synIDattr(synID(v:val[0], v:val[1], 1), \"name\")'), '{out}')",
             "-c", "qa!"], check=False, stdin=subprocess.DEVNULL, timeout=60)
        seen = dict(zip(WANTED, out.read_text().split("\n")))
    bad = {place: group for place, group in seen.items() if group != WANTED[place]}
    for place, group in bad.items():
        print(f"line {place[0]}, column {place[1]} is '{group}', expected '{WANTED[place]}'")
    return 1 if bad or len(seen) != len(WANTED) else 0


if __name__ == "__main__":
    sys.exit(main())
