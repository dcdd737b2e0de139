"""Makes the installer for Windows of ipos.exe, and the manifests by which winget and Chocolatey find it.
usage: setup.py IPOS.EXE FOLDER [--address URL]

FOLDER gets ipos-VERSION-windows-x86_64-setup.exe, and winget/ and chocolatey/ with its checksum. The address is where the
files of a release will be found; nobody publishes ipos yet, so it is an example's (ours)."""

import argparse
import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path.insert(0, str(HERE.parent))
from release import PARTS, version  # noqa: E402
from third_parties import write_notices  # noqa: E402

ADDRESS = "https://example.org/ipos/releases"


def make_setup(program: Path, out: Path) -> Path:
    kind = "windows-x86_64-setup.exe"
    setup = out / f"ipos-{version()}-{kind}"
    with tempfile.TemporaryDirectory() as folder:
        stage = Path(folder)
        for name in ("ipos.nsi", "path.nsh"):
            shutil.copy(HERE / name, stage)
        shutil.copy(ROOT / "tools/windows/ipos.ico", stage)
        shutil.copy(program, stage / "ipos.exe")
        # Windows' own editor shows lines that end with LF since 2018 alone.
        licence = (ROOT / "LICENSE").read_text(encoding="utf-8")
        (stage / "LICENSE.txt").write_text(licence, encoding="utf-8-sig", newline="\r\n")
        write_notices(PARTS[kind], stage / "NOTICES.txt")
        subprocess.run(["makensis", "-V2", f"-DVERSION={version()}", f"-DOUT={setup.name}", "ipos.nsi"], cwd=stage, check=True,
                       env={**os.environ, "LC_ALL": "C.UTF-8"})
        shutil.copy(stage / setup.name, setup)
    return setup


def make_manifests(setup: Path, out: Path, address: str) -> None:
    """The templates of winget/ and chocolatey/ with the version, the address and the checksum of the installer."""
    values = {"VERSION": version(), "ADDRESS": address, "SETUP": setup.name,
              "SHA256": hashlib.sha256(setup.read_bytes()).hexdigest().upper()}
    for template in sorted([*HERE.glob("winget/*"), *HERE.glob("chocolatey/**/*")]):
        if template.is_dir():
            continue
        text = re.sub(r"@(\w+)@", lambda name: values[name[1]], template.read_text(encoding="utf-8"))
        made = out / template.relative_to(HERE)
        made.parent.mkdir(parents=True, exist_ok=True)
        made.write_text(text, encoding="utf-8")


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("program", type=Path, help="ipos.exe")
    arguments.add_argument("folder", type=Path, help="gets the installer and the manifests")
    arguments.add_argument("--address", default=ADDRESS, help="the folder of releases on the net")
    wanted = arguments.parse_args()
    wanted.folder.mkdir(parents=True, exist_ok=True)
    setup = make_setup(wanted.program, wanted.folder)
    make_manifests(setup, wanted.folder, wanted.address)
    print(f"{setup.stat().st_size} bytes: {setup.name}")


if __name__ == "__main__":
    main()
