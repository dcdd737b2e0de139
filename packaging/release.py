"""Makes all files of a release in build/release-files, with SHA256SUMS and a bill of materials.
usage: release.py [--check]

With --check it is made a second time out of a clone in another folder, under another umask and time zone, and every file has to
be the same to the byte. What the host has no tools for is an error, not a smaller release."""

import argparse
import gzip
import hashlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

import sbom
from third_parties import ROOT, write_notices

BUILD = ROOT / "build"
NATIVE = BUILD / "release-native"  # without tests and asserts, beside the daily build
# The parts of third_parties.tsv in each kind of file; cmake/install.cmake and tools/CMakeLists.txt put the same into each.
PARTS = {
    "linux-x86_64": ["linux", "page", "plot"], "windows-x86_64.exe": ["windows", "page", "plot"],
    "windows-x86_64-setup.exe": ["windows", "page", "plot", "installer"], ".html": ["web", "page", "plot"],
    "site.tar.gz": ["web", "page", "plot", "site"], ".deb": ["deb", "page", "plot", "extension"],
    "fmu-libraries.zip": ["library", "windows-library"],
    "win_amd64.whl": ["windows-library"], "windows-x86_64.zip": ["windows-library"], ".whl": ["library"],
    ".vsix": ["extension"], ".tgz": ["web"], "source.tar.gz": ["page", "plot"], "Containerfile": [], "NOTICES.txt": [],
    ".zip": [], ".pack": [],  # firmware: the project's own sources alone
}


def run(*command, **more) -> None:
    print("+", *command, flush=True)
    subprocess.run([str(word) for word in command], check=True, cwd=more.pop("cwd", ROOT), **more)


def asked(*command: str) -> str:
    return subprocess.run(command, check=True, cwd=ROOT, capture_output=True, text=True).stdout.strip()


def version() -> str:
    return re.search(r"project\(ipos VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]


def pack_folder(folder: Path, name: str, out: Path, seconds: int) -> None:
    """A tar of the folder in which nothing depends on when and where it was packed."""
    def plain(entry: tarfile.TarInfo) -> tarfile.TarInfo:
        entry.uid = entry.gid = 0
        entry.uname = entry.gname = "root"
        entry.mtime = seconds
        entry.mode = 0o755 if entry.isdir() or entry.mode & 0o100 else 0o644
        return entry

    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w", format=tarfile.GNU_FORMAT) as tar:
        for path in [folder, *sorted(folder.rglob("*"))]:
            tar.add(path, Path(name) / path.relative_to(folder), recursive=False, filter=plain)
    out.write_bytes(gzip.compress(packed.getvalue(), 9, mtime=0))


def pack_again(archive: Path, out: Path) -> None:
    """The files of a zip in order, without times and rights of the host."""
    with zipfile.ZipFile(archive) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as new:
        for name in sorted(name for name in old.namelist() if not name.endswith("/")):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = (0o100755 if name.endswith(".so") else 0o100644) << 16
            new.writestr(entry, old.read(name))


def make_native(out: Path) -> None:
    run("cmake", "-S", ROOT, "-B", NATIVE, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DIPOS_TESTS=OFF")
    run("cmake", "--build", NATIVE, "--target", "all", "ipos_static", "ipos_vsix", "ipos_firmware_package")
    shutil.copy(NATIVE / "static/ipos", out / f"ipos-{version()}-linux-x86_64")
    pack_again(NATIVE / f"ipos-firmware-{version()}.zip", out / f"ipos-firmware-{version()}.zip")
    pack_again(NATIVE / f"ipos.ipos.{version()}.pack", out / f"ipos.ipos.{version()}.pack")
    pack_again(NATIVE / "vscode/ipos.vsix", out / f"ipos-{version()}.vsix")
    shutil.copy(out / f"ipos-{version()}.vsix", NATIVE / "vscode/ipos.vsix")  # the Debian package has the same one
    run("cpack", "--config", NATIVE / "CPackConfig.cmake", "-B", NATIVE / "pack")
    package, = (NATIVE / "pack").glob("ipos_*.deb")
    shutil.copy(package, out)
    run("lintian", "--tag-display-limit", "0", "--fail-on", "error", out / package.name)
    make_wheel(NATIVE / "lib/libipos_plant.so", out)


def make_wheel(library: Path, out: Path) -> None:
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder) / "python"
        shutil.copytree(ROOT / "python", copy, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info", "build"))
        run("/usr/bin/python3", "-m", "pip", "wheel", ".", "--no-build-isolation", "--no-deps", "--no-index", "-q", "-w", folder, cwd=copy,
            env={**os.environ, "IPOS_SOURCE": str(ROOT), "IPOS_PLANT_LIBRARY": str(library)})
        wheel, = Path(folder).glob("*.whl")
        pack_again(wheel, out / wheel.name)


def make_fmu_libraries(out: Path) -> None:
    """What `ipos fmu` puts into an FMU, to be laid beside a program that is one file."""
    name = out / f"ipos-{version()}-fmu-libraries.zip"
    with tempfile.TemporaryDirectory() as folder:
        notices = Path(folder) / "NOTICES.txt"
        write_notices(PARTS["fmu-libraries.zip"], notices)
        run("x86_64-w64-mingw32-strip", "-o", Path(folder) / "ipos_fmu.dll", BUILD / "windows/lib/ipos_fmu.dll")
        with zipfile.ZipFile(Path(folder) / "all.zip", "w") as archive:
            for file in (notices, NATIVE / "lib/libipos_fmu.so", Path(folder) / "ipos_fmu.dll"):
                archive.write(file, file.name)
        pack_again(Path(folder) / "all.zip", name)


def make_windows(out: Path) -> None:
    run("cmake/asmjit_source.sh", BUILD / "windows/asmjit")
    run("cmake", "--preset", "windows", "-DIPOS_JIT=ON")
    run("cmake", "--build", "--preset", "windows", "--target", "ipos", "ipos_plant", "ipos_fmu")
    program = out / f"ipos-{version()}-windows-x86_64.exe"
    run("x86_64-w64-mingw32-strip", "-o", program, BUILD / "windows/tools/ipos.exe")
    with tempfile.TemporaryDirectory() as folder:
        name = f"ipos-plant-{version()}-windows-x86_64"
        run("cmake", "--install", BUILD / "windows", "--prefix", Path(folder) / name, "--strip")
        pack_again(Path(shutil.make_archive(str(Path(folder) / "packed"), "zip", folder, name)), out / f"{name}.zip")
        make_wheel(Path(folder) / name / "bin/ipos_plant.dll", out)
        made = Path(folder) / "setup"
        run("/usr/bin/python3", "packaging/windows/setup.py", program, made)
        setup, = made.glob("*-setup.exe")
        shutil.copy(setup, out)
        manifests = out / f"ipos-{version()}-windows-manifests.zip"  # for winget and Chocolatey
        with zipfile.ZipFile(made / "all.zip", "w") as archive:
            for file in sorted(made.glob("*/**/*")):
                archive.write(file, file.relative_to(made))
        pack_again(made / "all.zip", manifests)


def make_web(out: Path, seconds: int) -> None:
    run("cmake", "--preset", "web")
    run("cmake", "--build", "--preset", "web", "--target", "ipos_site", "ipos_wasm_package")
    page = BUILD / "web/ipos.html"
    shutil.copy(page, out / f"ipos-{version()}.html")
    run("/usr/bin/python3", "packaging/site/build.py", BUILD / "web/site/docs", page)
    write_notices(PARTS["site.tar.gz"], BUILD / "web/site/NOTICES.txt")
    pack_folder(BUILD / "web/site", f"ipos-{version()}-site", out / f"ipos-{version()}-site.tar.gz", seconds)
    for manifest in sorted((ROOT / "web").glob("*/package.json")):  # packages for pages of others
        package = BUILD / "web" / manifest.parent.name
        run("npm", "pack", "--ignore-scripts", "--pack-destination", out,
            cwd=package if (package / "package.json").exists() else manifest.parent)


def make_sources(out: Path) -> None:
    name = f"ipos-{version()}"
    tar = subprocess.run(["git", "archive", "--format=tar", f"--prefix={name}/", "HEAD"], cwd=ROOT, check=True, capture_output=True)
    (out / f"{name}-source.tar.gz").write_bytes(gzip.compress(tar.stdout, 9, mtime=0))
    shutil.copy(ROOT / "Dockerfile", out / "Containerfile")
    write_notices(sorted({part for parts in PARTS.values() for part in parts}), out / "NOTICES.txt")


def make(out: Path) -> None:
    seconds = int(asked("git", "log", "-1", "--format=%ct"))
    os.environ.update(SOURCE_DATE_EPOCH=str(seconds), LC_ALL="C.UTF-8", TZ="UTC", PYTHONHASHSEED="0")
    os.umask(0o022)
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    make_sources(out)
    make_native(out)
    make_windows(out)
    make_fmu_libraries(out)
    make_web(out, seconds)
    files = {file: next(parts for end, parts in PARTS.items() if file.name.endswith(end)) for file in sorted(out.iterdir())}
    bill = sbom.bill(version(), asked("git", "rev-parse", "HEAD"), seconds, files)
    (out / f"ipos-{version()}.spdx.json").write_text(json.dumps(bill, indent=1, ensure_ascii=False) + "\n")
    sums = "".join(f"{hashlib.sha256(file.read_bytes()).hexdigest()}  {file.name}\n" for file in sorted(out.iterdir()))
    (out / "SHA256SUMS").write_text(sums)


def differences(one: Path, other: Path) -> list[str]:
    names = {file.name for file in [*one.iterdir(), *other.iterdir()]}
    return sorted(name for name in names if not (one / name).exists() or not (other / name).exists()
                  or (one / name).read_bytes() != (other / name).read_bytes())


def check(out: Path) -> None:
    with tempfile.TemporaryDirectory(prefix="ipos-another-folder-") as folder:
        clone = Path(folder) / "clone"
        run("git", "clone", "-q", ROOT, clone)
        run(sys.executable, "packaging/release.py", cwd=clone, env={**os.environ, "TZ": "Asia/Tokyo"}, umask=0o077)
        different = differences(out, clone / "build/release-files")
        kept = BUILD / "release-files-second"
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(clone / "build/release-files", kept)
    for name in different:
        print(f"not the same in the second build: {name}")
    print(f"second build: {len(list(out.iterdir())) - len(different)} files the same, {len(different)} not")
    raise SystemExit(1 if different else 0)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--check", action="store_true", help="make it a second time in another folder and compare")
    wanted = arguments.parse_args()
    if asked("git", "status", "--porcelain", "--untracked-files=no"):
        raise SystemExit("release.py: a release is made of a commit, and files were changed")
    out = BUILD / "release-files"
    make(out)
    print("\n" + (out / "SHA256SUMS").read_text())
    for file in sorted(out.iterdir()):
        print(f"{file.stat().st_size:>10}  {file.name}")
    if wanted.check:
        check(out)


if __name__ == "__main__":
    main()
