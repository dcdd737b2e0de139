"""What of third parties is in the site of docs/: each file beside the pages is looked up among the files of Debian's packages, and
each name with a version at the head of a part is compared with packaging/third_parties.tsv. Used by site_links.py."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "packaging"))
from third_parties import rows  # noqa: E402

PYTHON = Path("/usr/lib/python3/dist-packages")
# Where Sphinx, its themes and what they take lie.
SHELVES = [Path("/usr/share/sphinx/themes"), Path("/usr/share/javascript"), Path("/usr/share/nodejs/normalize.css"),
           *(PYTHON / name for name in ("sphinx", "furo", "sphinx_basic_ng", "myst_parser", "pygments"))]
# Written while the site is made, of a template or a table of that package.
MADE = {"pygments.css": "deb:python3-pygments", "basic.css": "deb:sphinx-common", "language_data.js": "deb:sphinx-common",
        "documentation_options.js": "deb:sphinx-common"}
OURS = {"ipos-plant.js"}  # the package ipos-wasm: parts `web` of the table
# "Sizzle CSS Selector Engine v2.3.6", "//     Underscore.js 1.13.4"
HEAD = re.compile(r"^\s*(?:/\*!?|\*|//)\s+([A-Za-z][\w.]*)((?: [A-Za-z]+)*) v?(\d+\.\d+\.\d+)\b", re.MULTILINE)
smallest = 200  # bytes: a shorter file may be within another by chance


def package_of(file: Path) -> str:
    asked = subprocess.run(["dpkg", "-S", str(file.resolve())], capture_output=True, text=True)
    return "deb:" + asked.stdout.split(":")[0] if asked.returncode == 0 else ""


def look_into(site: Path) -> list[str]:
    """What the table lacks, or says too much."""
    wrong: list[str] = []
    known: dict[bytes, Path] = {}
    for shelf in SHELVES:
        for file in sorted(shelf.rglob("*")):
            if file.suffix in (".js", ".css", ".png", ".svg", ".woff2") and file.is_file() and file.stat().st_size >= 80:
                known.setdefault(file.read_bytes(), file)
    table = [row for row in rows() if "site" in row["in"]]
    found: set[str] = set()
    heads: dict[str, str] = {}
    for file in sorted((site / "_static").rglob("*")):
        if not file.is_file() or file.name in OURS:
            continue
        content = file.read_bytes()
        # build.py puts some together.
        parts = [path for part, path in known.items() if part == content or (len(part) >= smallest and part in content)]
        packages = {package_of(path) for path in parts} - {""}
        if file.name in MADE:
            packages.add(MADE[file.name])
        if file.name == "furo.css":  # its import is replaced by what it imports
            packages.add("deb:furo")
        if not packages:
            wrong.append(f"_static/{file.relative_to(site / '_static')} is of no package that is known here")
        found |= packages
        if file.suffix in (".js", ".css"):
            heads.update({name: version for name, _, version in HEAD.findall(content.decode())})
    named = {package for row in table for package in row["found"]}
    for package in sorted(found - named):
        wrong.append(f"the site contains {package}, which packaging/third_parties.tsv does not say")
    for row in table:
        if not found & set(row["found"]):
            wrong.append(f"packaging/third_parties.tsv says that the site contains {row['name']}; it was not found there")
    versions = {row["name"].lower(): row["version"] for row in table}
    for name, version in sorted(heads.items()):
        if versions.get(name.lower()) != version:
            wrong.append(f"the site contains {name} {version}, packaging/third_parties.tsv says {versions.get(name.lower(), 'nothing')}")
    # Those without a head: as Debian's package has it, 2022.12.07+dfsg-1 and 1.0.0~beta1-3 being 2022.12.7 and 1.0.0b1.
    for row in table:
        if row["name"].lower() in ("sphinx", "furo", "sphinx-basic-ng", "pygments"):
            asked = subprocess.run(["dpkg-query", "-W", "-f=${Version}", row["found"][0].removeprefix("deb:")], capture_output=True, text=True)
            upstream = re.split(r"[+-]", asked.stdout)[0].replace("~beta", "b")
            if re.sub(r"\b0+(?=\d)", "", upstream) != row["version"]:
                wrong.append(f"{row['name']} {row['version']} is {asked.stdout} here")
        elif row["name"].lower() not in {name.lower() for name in heads}:
            wrong.append(f"the site has no part that says it is {row['name']}")
    print(f"site: {', '.join(sorted(found))}; {', '.join(' '.join(one) for one in sorted(heads.items()))}")
    return wrong
