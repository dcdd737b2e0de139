"""Makes the pages of docs/ a site that needs no server: build.py OUT [IPOS_HTML]

The Markdown is laid out in a folder as the site will have it, README.md as its beginning, and Sphinx makes HTML of that. A link
to a page leads to that page, a link to an example's folder to a page with its files, and a link to any other file of the
sources, which the site does not have, becomes its text. With IPOS_HTML, which goes into the folder above OUT, each example runs
beside its text, and so does an element <ipos-plant src="EXAMPLE"> where the npm package lies beside that file."""

import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
# A picture or a link; the words may have brackets in code.
LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
ELEMENT = re.compile(r'<ipos-plant src="([^"]+)"([^>]*)></ipos-plant>')
RUNNING = "build/web/ipos.html"  # examples and messages have links into it (docs/guide/browser.md)
RENAMED = {"README.md": "index.md", "docs/README.md": "pages.md", "examples/README.md": "examples/index.md",
           "CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md", "SECURITY.md": "security.md"}


def example_folders() -> list[Path]:
    return sorted(folder for folder in (ROOT / "examples").iterdir() if list(folder.glob("*.toml")))


def pages() -> dict[str, str]:
    """Where each page of the repository stands in the site, both from their roots."""
    found = {page: place for page, place in RENAMED.items() if (ROOT / page).exists()}
    for page in sorted((ROOT / "docs").rglob("*.md")):
        name = page.relative_to(ROOT).as_posix()
        found.setdefault(name, name.removeprefix("docs/"))
    for folder in (ROOT / "docs/reference/diagnostics", ROOT / "docs/reference/protocols"):
        name = folder.relative_to(ROOT).as_posix()
        found[name] = f"{name.removeprefix('docs/')}/index.md"
    for folder in example_folders():
        found[folder.relative_to(ROOT).as_posix()] = f"examples/{folder.name}.md"
    return found


def moved(text: str, page: str, places: dict[str, str], runs: bool) -> str:
    """The Markdown of a page with its links as the site needs them; code stays as it is."""

    def link(match: re.Match) -> str:
        picture, words, target = match.groups()
        path, hash_, anchor = target.partition("#")
        if "://" in target or not path:
            return match.group(0)
        named = os.path.normpath(os.path.join(os.path.dirname(page), path))
        place = "../ipos.html" if named == RUNNING and runs else places.get(named)
        if picture and named.startswith("docs/"):
            place = named.removeprefix("docs/")
        if place is None:
            assert named == RUNNING or (ROOT / named).exists(), f"{page}: {target} leads nowhere"
            return words
        if named == RUNNING:  # no page of Sphinx
            away = os.path.relpath(place, os.path.dirname(places[page]) or ".")
            return f'<a href="{away}{hash_}{anchor}">{words}</a>'
        return f"{picture}[{words}]({os.path.relpath(place, os.path.dirname(places[page]) or '.')}{hash_}{anchor})"

    parts = re.split(r"(^```.*?^```$)", text, flags=re.MULTILINE | re.DOTALL)
    return "".join(part if part.startswith("```") else LINK.sub(link, part) for part in parts)


def with_elements(text: str, page: str, place: str, runs: bool) -> str:
    """A page of a folder cannot fetch: the files of an element stand in it. Without the package it is left out."""

    def element(match: re.Match) -> str:
        if not runs:
            return ""
        plant = ROOT / os.path.normpath(os.path.join(os.path.dirname(page), match[1]))
        files = {file.name: file.read_text() for file in [plant, *sorted(plant.parent.glob("*.IPC"))]}
        script = os.path.relpath("_static/ipos-plant.js", os.path.dirname(place) or ".")
        inside = json.dumps(files).replace("<", "\\u003c")
        return (f'<div>\n<ipos-plant{match[2]}><script type="application/json">{inside}</script></ipos-plant>\n'
                f'<script src="{script}"></script>\n</div>')

    parts = re.split(r"(^```.*?^```$|`[^`\n]*`)", text, flags=re.MULTILINE | re.DOTALL)
    return "".join(part if part.startswith("`") else ELEMENT.sub(element, part) for part in parts)


def example_page(folder: Path, runs: bool) -> str:
    files = sorted(file for file in folder.iterdir() if file.suffix in {".IPC", ".toml", ".h"})
    text = f"# {folder.name}\n\n`ipos serve examples/{folder.name}` shows it; `ipos new DIR --from {folder.name}` copies it.\n"
    if runs:
        text += ('\n<details><summary>Run it here</summary>\n<iframe loading="lazy" title="ipos" width="100%" height="640" '
                 f'src="../../ipos.html#example={folder.name}"></iframe>\n</details>\n')
    for file in files:
        language = {".IPC": "ipc", ".toml": "toml", ".h": "c"}[file.suffix]
        text += f"\n## {file.name}\n\n```{language}\n{file.read_text().rstrip()}\n```\n"
    return text


def heading(page: Path) -> str:
    return next(line for line in page.read_text().splitlines() if line.startswith("# "))[2:]


def contents(title: str, places: list[str]) -> str:
    return f"```{{toctree}}\n:hidden:\n:caption: {title}\n\n" + "\n".join(place.removesuffix(".md") for place in places) + "\n```\n"


def shelves(places: dict[str, str]) -> str:
    """The side bar: the pages in the order of docs/README.md, by its shelves."""
    text = contents("Project", [places[page] for page in RENAMED if page in places and page != "README.md"])
    for shelf in re.split(r"^\*\*", (ROOT / "docs/README.md").read_text(), flags=re.MULTILINE)[1:]:
        title, rest = shelf.split("**", 1)
        named = [os.path.normpath("docs/" + target) for _, _, target in LINK.findall(rest)]
        text += contents(title, [places[page] for page in named if page in places and page not in RENAMED])
    return text


def lay_out(folder: Path, runs: bool, elements: bool) -> None:
    places = pages()
    written: dict[str, str] = {}
    for page, place in places.items():
        if (ROOT / page).is_file():
            written[place] = with_elements(moved((ROOT / page).read_text(), page, places, runs), page, place, elements)
        elif page.startswith("examples/"):
            written[place] = example_page(ROOT / page, runs)
        else:
            names = sorted(path.stem for path in (ROOT / page).glob("*.md"))
            title = {"diagnostics": "Messages", "protocols": "Protocols"}[Path(page).name]
            lines = [f"- [{heading(ROOT / page / (name + '.md'))}]({name}.md)" for name in names]
            written[place] = f"# {title}\n\n" + "\n".join(lines) + "\n"
    written["index.md"] += "\n" + shelves(places)
    listed = set(re.findall(r"^[\w/-]+$", written["index.md"], re.MULTILINE))
    for place, text in written.items():
        (folder / place).parent.mkdir(parents=True, exist_ok=True)
        # The side bar would be long, and slow to make, with every message and example in it; pages of theirs list them.
        orphan = place != "index.md" and place.removesuffix(".md") not in listed
        (folder / place).write_text(("---\norphan: true\n---\n" if orphan else "") + text)
    shutil.copytree(ROOT / "docs/images", folder / "images", ignore=shutil.ignore_patterns("*.py", "*.sh"))
    shutil.copy(HERE / "conf.py", folder)


def stand_alone(static: Path) -> None:
    """Debian's Furo counts on a web server: its script is a module, and its style sheet imports one of Debian's server."""
    script = static / "scripts/furo.js"
    library = static / "scripts/gumshoe-patched.js"
    own = script.read_text()
    imported = 'import Gumshoe from "./gumshoe-patched.js";\n'
    assert own.startswith(imported), "another Furo: see whether its script still needs this"
    script.write_text(library.read_text() + own.removeprefix(imported))
    library.unlink()
    style = static / "styles/furo.css"
    for address in re.findall(r"@import url\((/javascript/[^)]*)\);", style.read_text()):
        text = style.read_text().replace(f"@import url({address});", Path("/usr/share" + address).read_text())
        style.write_text(text)


def main() -> None:
    out = Path(sys.argv[1]).resolve()
    page = Path(sys.argv[2]) if len(sys.argv) > 2 else None
    package = page.parent / "ipos-wasm/ipos-plant.js" if page else None
    package = package if package and package.exists() else None
    with tempfile.TemporaryDirectory() as work:
        source = Path(work) / "source"
        source.mkdir()
        lay_out(source, page is not None, package is not None)
        shutil.rmtree(out, ignore_errors=True)
        # Hashes of Python's own are the order of some of its lists.
        subprocess.run([os.environ.get("SPHINX", "/usr/bin/sphinx-build"), "-q", "-W", "--keep-going", "-b", "html",
                        "-d", f"{work}/trees", str(source), str(out)], check=True, env={**os.environ, "PYTHONHASHSEED": "0"})
    (out / ".buildinfo").unlink()
    stand_alone(out / "_static")
    if package is not None:
        shutil.copy(package, out / "_static")
    if page is not None and page.resolve() != (out.parent / "ipos.html"):
        shutil.copy(page, out.parent / "ipos.html")
    print(f"{out}/index.html")


if __name__ == "__main__":
    main()
