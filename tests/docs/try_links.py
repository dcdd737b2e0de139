#!/usr/bin/env python3
"""Links that run: each example in examples/README.md, each page of a message that has an IPOS program, the programs and plants of
the guides, and README lead into build/web/ipos.html, which ./dev web makes; the site has that page, too (docs/guide/browser.md).
  try_links.py PROJECT            tells what is missing or differs, and what has no link and why; exit 1 when something differs
  try_links.py PROJECT --write    puts it right"""
import pathlib
import re
import sys
import tomllib

import plant_link

PAGE = "build/web/ipos.html"
ROW = re.compile(r"^\| \[([\w-]+)\]\(\1\)(?: \[try\]\([^)]*\))? \|", re.M)
LINE = re.compile(r"^\[Try it\]\(.*\n", re.M)
# A fence, and its link where it has one.
BLOCK = re.compile(r"^```(ipc|ipa|c|toml)\n(.*?)^```\n(?:\n\[Try it\]\(([^)\n]*)\)\n)?", re.M | re.S)
# The files of a folder as one link: <!-- try FOLDER NAME PLANT -->
FOLDER = re.compile(r"^(<!-- try (\S+) (\S+) (\S+) -->\n)(?:\[Try it\]\(([^)\n]*)\)\n)?", re.M)
NO_ASSEMBLER = "assembler text, which `ipos asm` reads and no view of the page edits"
without = []  # place and reason


def of_example(page, folder):
    def row(found):
        name = found[1]
        plants = [p for p in (folder / name).glob("*.toml") if not p.name.endswith((".test.toml", ".campaign.toml"))]
        if not plants:
            without.append((f"examples/{name}", "no plant file: a program in C or Python that embeds one"))
        link = f" [try](../{PAGE}#example={name})" if plants else ""
        return f"| [{name}]({name}){link} |"

    return ROW.sub(row, page)


def of_message(page, code):
    page = LINE.sub("", page)
    if "```ipc\n" not in page:
        without.append((code, NO_ASSEMBLER))
        return page
    title, rest = page.split("\n", 1)
    address = f"../../../{PAGE}#message={code}"
    return f"{title}\n[Try it]({address}) or [its mended program]({address}.right)\n{rest}"


def why_no_plant(text):
    """Of a block of TOML. None: it is a whole plant."""
    plant = tomllib.loads(text)
    if not plant.get("station") or any("name" not in one or "unit" not in one for one in plant["station"]):
        return "part of a plant file"
    if any("program" in one for one in plant["station"]):
        return "programs that the page does not have"
    lines = {one["name"] for one in plant.get("bus", []) if "name" in one}
    named = {one[key] for one in plant["station"] for key in ("sbus", "sbus2", "rs485", "profibus") if key in one}
    return f"lines that the page does not have: {', '.join(sorted(named - lines))}" if named - lines else None


def what_runs(kind, text, examples):
    """Of a block: name of an example, or name of a file; or the reason why neither. All None: it is no program."""
    if kind == "ipa":
        return None, None, NO_ASSEMBLER
    if kind == "toml":
        reason = why_no_plant(text)
        return None, None if reason else "plant.toml", reason
    if not re.search(r"\bmain\s*\(\s*\)", text):
        return None, None, None
    same = [file.parent.name for file in sorted(examples.glob("*/*.IPC")) if file.read_text() == text]
    return (same[0], None, None) if same else (None, "MAIN.IPC", None)


def kept_or_new(link, wanted):
    """A link that has the wanted content stays: another version of zlib packs in another way."""
    name, plant, files = wanted
    if link and plant_link.BEGIN in link and plant_link.read(link) == wanted:
        return plant_link.BEGIN + link.split(plant_link.BEGIN)[1]
    return plant_link.write(name, plant, files)


def of_guide(page, place, project):
    up = "../" * (len(place.parts) - 1)
    number = 0

    def block(found):
        nonlocal number
        kind, text, link = found.groups()
        fence = f"```{kind}\n{text}```\n"
        example, file, reason = what_runs(kind, text, project / "examples")
        if reason:
            without.append((f"{place}:{page[:found.start()].count(chr(10)) + 1}", reason))
        if example is None and file is None:
            return fence
        number += 1
        folder = f"{place.stem}-{number}"
        fragment = f"#example={example}" if example else kept_or_new(link, (folder, file, {file: text.encode()}))
        return f"{fence}\n[Try it]({up}{PAGE}{fragment})\n"

    def folder(found):
        marker, source, name, plant, link = found.groups()
        files = {file.name: file.read_bytes() for file in (project / source).iterdir() if file.suffix in (".IPC", ".toml")}
        return f"{marker}[Try it]({up}{PAGE}{kept_or_new(link, (name, plant, files))})\n"

    return FOLDER.sub(folder, BLOCK.sub(block, page))


def main():
    project = pathlib.Path(sys.argv[1])
    write = "--write" in sys.argv[2:]
    wanted = {}
    index = project / "examples/README.md"
    wanted[index] = of_example(index.read_text(), index.parent)
    messages = project / "docs/reference/diagnostics"
    for path in sorted(messages.glob("[A-Z]*.md")):
        wanted[path] = of_message(path.read_text(), path.stem)
    for path in [*sorted((project / "docs/guide").glob("*.md")), messages / "comparison.md"]:
        wanted[path] = of_guide(path.read_text(), path.relative_to(project), project)
    differ = [path for path, text in wanted.items() if path.read_text() != text]
    for path in differ:
        if write:
            path.write_text(wanted[path])
        else:
            print(f"{path}: its links are not those of tests/docs/try_links.py --write")
    for place, reason in without:
        print(f"{place} has no link: {reason}")
    links = sum(text.count(f"{PAGE}#") for text in wanted.values())
    packed = sum(text.count(f"{PAGE}{plant_link.BEGIN}") for text in wanted.values())
    print(f"{links} links in {len(wanted)} pages, {packed} of them with a plant inside, "
          f"{len(differ)} pages {'written' if write else 'differ'}")
    if f"({PAGE}#example=hoist)" not in (project / "README.md").read_text():
        sys.exit("README.md has no link to the hoist")
    sys.exit(1 if differ and not write else 0)


main()
