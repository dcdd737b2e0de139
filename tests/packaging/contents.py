"""packaging/third_parties.tsv names what is really in the things that the project gives away, and no more.

What is in a program is found by the files that the compiler read (ninja's own record), the archives that the linker took and
the files that Bison wrote; Debian's package of each is asked of dpkg. What is in the page and in the extension is found by
esbuild's own account of its output, with the packages' versions and licences.
usage: contents.py BUILD [WEB_PACKAGES] [EXTENSION_PACKAGES]      BUILD is build/release, build/windows or build/web"""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "packaging"))
from third_parties import rows  # noqa: E402

wrong: list[str] = []


def output(*command: str) -> str:
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def debian_packages(files: set[str]) -> set[str]:
    """Which packages the files belong to; files that belong to none are of the compiler's own making."""
    real = sorted({str(Path(file).resolve()) for file in files})
    asked = subprocess.run(["dpkg", "-S", *real], capture_output=True, text=True)
    return {"deb:" + line.split(":")[0] for line in asked.stdout.splitlines() if not line.startswith("diversion")}


def read_by(build: Path, targets: list[str]) -> set[str]:
    """What the objects of some targets were made of, outside of the sources and the build."""
    inputs = output("ninja", "-C", str(build), "-t", "inputs", *targets).split("\n")
    objects = {line for line in inputs if line.endswith((".o", ".obj", ".gch"))}
    files: set[str] = set()
    taken = False
    for line in output("ninja", "-C", str(build), "-t", "deps").splitlines():
        if not line.startswith(" "):
            taken = line.split(":")[0] in objects
        elif taken and not line.strip().startswith(str(ROOT)) and Path(line.strip()).is_absolute():
            files.add(line.strip())
        elif taken and "headers/" in line:  # links to headers of Debian (cmake/header_packages.cmake)
            files.add(str((build / line.strip())))
    return files


def archives(build: Path, target: str) -> set[str]:
    commands = output("ninja", "-C", str(build), "-t", "commands", target).splitlines()
    return {word for word in re.split(r"[\s=]+", commands[-1]) if word.startswith("/usr") and word.endswith(".a")}


def compare(artefact: str, found: set[str], ours: list[str]) -> None:
    """`ours` are packages whose files only help to build."""
    table = [row for row in rows() if artefact in row["in"]]
    named = {package for row in table for package in row["found"]}
    for package in sorted(found - named - set(ours)):
        wrong.append(f"{artefact} contains {package}, which packaging/third_parties.tsv does not say")
    for row in table:
        if not found & set(row["found"]):
            wrong.append(f"packaging/third_parties.tsv says that {artefact} contains {row['name']}; it was not found there")
    print(f"{artefact}: {', '.join(sorted(found))}")


def compiled(build: Path) -> None:
    system = {"release": "linux"}.get(build.name, build.name)
    libraries = ["lib/libipos_plant.so", "lib/libipos_fmu.so", "lib/libipos_compile.so", "lib/libipos.so"]
    targets = {"linux": {"linux": ["static/ipos"], "library": libraries, "deb": ["tools/ipos", *libraries]},
               "windows": {"windows": ["tools/ipos.exe"], "windows-library": ["lib/ipos_plant.dll"]}, "web": {"web": ["tools/ipos.js"]}}[system]
    for artefact, made in targets.items():
        files = read_by(build, made).union(*(archives(build, target) for target in made))
        found = debian_packages(files)
        written = list((build / "compiler/generated").rglob("*.cpp"))
        if any("made by GNU Bison" in file.read_text() for file in written):
            found.add("deb:bison")
        if artefact == "windows" and (build / "asmjit/src").is_dir():  # built of Debian's source
            found.add("deb:libasmjit-dev")
        compare(artefact, found, SHARED if artefact in ("deb", "library", "windows-library") else ["deb:libc6-dev"] if system != "linux" else [])


# Of these only names and numbers are in what uses the shared libraries.
SHARED = ["deb:libc6-dev", "deb:linux-libc-dev", "deb:libedit-dev", "deb:zlib1g-dev", "deb:libexpat1-dev"]

BUNDLES = """
import { build } from "esbuild";
const results = [];
for (const [artefact, entry, options] of JSON.parse(process.argv[2])) {
  const made = await build({ entryPoints: [entry], bundle: true, write: false, metafile: true, outdir: "out", ...options });
  for (const output of Object.values(made.metafile.outputs))
    for (const [input, { bytesInOutput }] of Object.entries(output.inputs)) if (bytesInOutput) results.push([artefact, input]);
}
console.log(JSON.stringify(results));
"""


def bundled(folder: Path, bundles: list) -> None:
    script = folder / "contents.mjs"
    script.write_text(BUNDLES)
    asked = subprocess.run(["node", script.name, json.dumps(bundles)], cwd=folder, capture_output=True, text=True)
    script.unlink()
    if asked.returncode != 0:
        raise SystemExit(asked.stderr)
    packages: dict[str, dict[str, dict]] = {artefact: {} for artefact, _, _ in bundles}
    for artefact, file in json.loads(asked.stdout):
        place = re.match(r"(.*node_modules/((?:@[^/]+/)?[^/]+))/", file)
        if place:
            packages[artefact]["npm:" + place[2]] = json.loads((folder / place[1] / "package.json").read_text())
    for artefact, found in packages.items():
        compare(artefact, set(found), [])
        for row in rows():
            for package in found.keys() & set(row["found"]):
                has = (found[package]["version"], found[package]["license"])
                if artefact in row["in"] and has != (row["version"], row["licence"]):
                    wrong.append(f"{artefact} contains {row['name']} {' '.join(has)}, the table says {row['version']} {row['licence']}")


def versions() -> None:
    """Of Debian's packages: the version upstream, as far as the table gives it."""
    installed = dict(line.split("\t") for line in output("dpkg-query", "-W", "-f=${Package}\t${Version}\n").splitlines())
    for row in rows():
        for package in row["found"]:
            kind, name = package.split(":", 1)
            if kind == "deb" and name in installed and row["name"] not in WITHIN:
                upstream = re.sub(r"^\d+:", "", installed[name]).replace("0.0~git", "")
                if not re.match(re.escape(row["version"].split("-")[0]) + r"($|[^0-9])", upstream.replace("3.1-", "")):
                    wrong.append(f"{row['name']} {row['version']} is {installed[name]} here")


# Sources that another package of Debian has within its own, with versions of their own.
WITHIN = {"musl", "winpthreads", "LLVM runtime libraries (libc++, libc++abi, libunwind, compiler-rt)", "sphinx-basic-ng", "Furo",
          "Sizzle", "gumshoejs"}


def main() -> None:
    build = Path(sys.argv[1])
    if not shutil.which("dpkg") or not shutil.which("ninja"):
        print("skipped: the packages of Debian tell what is in a program, and ninja what it was made of")
        raise SystemExit(77)
    for row in rows():
        if not (ROOT / "packaging/licences" / f"{row['text']}.txt").is_file():
            wrong.append(f"{row['name']} has no text")
    compiled(build)
    versions()
    for folder in sys.argv[2:]:
        if not Path(folder, "node_modules/esbuild").is_dir():
            print(f"not looked at: there are no packages of npm in {folder}")
    if len(sys.argv) > 2 and Path(sys.argv[2], "node_modules/esbuild").is_dir():
        page = {"jsx": "automatic", "jsxImportSource": "preact", "minify": True}
        bundled(Path(sys.argv[2]), [["page", "src/main.tsx", page], ["page", "src/style/page.css", {}],
                                    ["page", "src/alone/worker.ts", {}],
                                    ["plot", "src/picture/plot_page.ts", {"loader": {".css": "text"}}]])
    if len(sys.argv) > 3 and Path(sys.argv[3], "node_modules/esbuild").is_dir():
        bundled(Path(sys.argv[3]), [["extension", "src/extension.ts", {"platform": "node", "external": ["vscode"]}]])
    print("\n".join(wrong))
    raise SystemExit(1 if wrong else 0)


if __name__ == "__main__":
    main()
