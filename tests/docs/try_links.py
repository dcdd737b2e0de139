#!/usr/bin/env python3
"""Links that run: each example in examples/README.md, each page of a message that has an IPOS program, and README lead into
build/web/ipos.html, which ./dev web makes; the site has that page, too (docs/guide/browser.md).
  try_links.py PROJECT            tells what is missing or differs; exit 1 then
  try_links.py PROJECT --write    puts it right"""
import pathlib
import re
import sys

PAGE = "build/web/ipos.html"
ROW = re.compile(r"^\| \[([\w-]+)\]\(\1\)(?: \[try\]\([^)]*\))? \|", re.M)
LINE = re.compile(r"^\[Try it\]\(.*\n", re.M)


def of_example(page, folder):
    def row(found):
        name = found[1]
        plants = [p for p in (folder / name).glob("*.toml") if not p.name.endswith(".test.toml")]
        link = f" [try](../{PAGE}#example={name})" if plants else ""
        return f"| [{name}]({name}){link} |"

    return ROW.sub(row, page)


def of_message(page, code):
    page = LINE.sub("", page)
    if "```ipc\n" not in page:  # the editor has no assembler text
        return page
    title, rest = page.split("\n", 1)
    address = f"../../../{PAGE}#message={code}"
    return f"{title}\n[Try it]({address}) or [its mended program]({address}.right)\n{rest}"


def main():
    project = pathlib.Path(sys.argv[1])
    write = "--write" in sys.argv[2:]
    wanted = {}
    index = project / "examples/README.md"
    wanted[index] = of_example(index.read_text(), index.parent)
    for path in sorted((project / "docs/reference/diagnostics").glob("[A-Z]*.md")):
        wanted[path] = of_message(path.read_text(), path.stem)
    differ = [path for path, text in wanted.items() if path.read_text() != text]
    for path in differ:
        if write:
            path.write_text(wanted[path])
        else:
            print(f"{path}: its links are not those of tests/docs/try_links.py --write")
    links = sum(text.count(f"{PAGE}#") for text in wanted.values())
    print(f"{links} links in {len(wanted)} pages, {len(differ)} pages {'written' if write else 'differ'}")
    if f"({PAGE}#example=hoist)" not in (project / "README.md").read_text():
        sys.exit("README.md has no link to the hoist")
    sys.exit(1 if differ and not write else 0)


main()
