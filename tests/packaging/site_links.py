"""The site of docs/: Sphinx makes it without a warning, every link and picture of it leads to a file and to an id in it, it asks
no server for anything, its search knows its words, and packaging/third_parties.tsv names what is in it.
usage: site_links.py SOURCE [SITE]      makes the site in a folder of its own if SITE is not given"""

import re
import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlparse

from site_contents import look_into

wrong: list[str] = []


class Page(HTMLParser):
    def __init__(self, file: Path) -> None:
        super().__init__()
        self.ids: set[str] = set()
        self.links: list[tuple[str, str]] = []  # tag, address
        self.feed(file.read_text())

    def handle_starttag(self, tag: str, attributes: list) -> None:
        for name, value in attributes:
            if name == "id" or (tag == "a" and name == "name"):
                self.ids.add(value)
            elif name in ("href", "src") and value:
                self.links.append((tag, value))


def look_at(site: Path) -> None:
    pages = {file: Page(file) for file in sorted(site.rglob("*.html"))}
    count = 0
    for file, page in pages.items():
        for tag, link in page.links:
            address = urlparse(link)
            where = f"{file.relative_to(site)}: <{tag}> {link[:80]}"
            if address.scheme == "data" or link in ("#",):
                continue
            if address.scheme or address.netloc:
                if tag != "a":
                    wrong.append(f"{where} asks another computer")
                continue
            count += 1
            target = (file.parent / unquote(address.path)).resolve() if address.path else file
            if not target.is_file():
                wrong.append(f"{where} leads nowhere")
            elif address.fragment and tag == "a" and target in pages and unquote(address.fragment) not in pages[target].ids:
                wrong.append(f"{where}: there is no such place on the page")
    for style in site.rglob("*.css"):
        for address in re.findall(r"""url\(['"]?([^'")]*)""", style.read_text()):
            if not address.startswith("data:") and not (style.parent / address).is_file():
                wrong.append(f"{style.relative_to(site)}: {address} leads nowhere")
    for script in site.rglob("*.js"):
        if re.search(r"^(import|export)\b", script.read_text(), re.MULTILINE):
            wrong.append(f"{script.relative_to(site)} is a module, which a page of a folder cannot load")
    for name in ("index.html", "guide/tutorial.html", "reference/diagnostics/E0201.html", "examples/hoist.html"):
        if site / name not in pages:
            wrong.append(f"there is no {name}")
    index = (site / "searchindex.js").read_text()
    for word in ("hoist", "movilink", "profibus"):
        if f"{word}:" not in index and f'"{word}":' not in index:
            wrong.append(f"the search does not know '{word}'")
    wrong.extend(look_into(site))
    print(f"{len(pages)} pages, {count} links within")


def main() -> None:
    source = Path(sys.argv[1])
    if len(sys.argv) > 2:
        look_at(Path(sys.argv[2]).resolve())
    else:
        asked = subprocess.run(["/usr/bin/python3", "-c", "import furo, myst_parser"], capture_output=True)
        if asked.returncode != 0:
            print("skipped: furo and python3-myst-parser are not installed")
            raise SystemExit(77)
        with tempfile.TemporaryDirectory() as folder:
            site = Path(folder).resolve() / "site/docs"
            subprocess.run(["/usr/bin/python3", source / "packaging/site/build.py", site], check=True)
            look_at(site)
    print("\n".join(wrong))
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
