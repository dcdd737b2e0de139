"""The installer for Windows under wine: what it puts where, a second time over the first, and that its uninstaller leaves
nothing but what was there before. PATH may be long, and keeps its kind; files that other programs open stay theirs.
usage: setup_test.py IPOS.EXE"""

import hashlib
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def skip(why: str) -> None:
    print(f"skipped: {why}")
    sys.exit(77)


program = Path(sys.argv[1])
if not program.exists():
    skip(f"there is no {program}: ./dev windows builds it")
for tool in ("wine", "makensis"):
    if not shutil.which(tool):
        skip(f"{tool} is not installed")
folder = Path(tempfile.mkdtemp())
prefix = folder / "prefix"
os.environ.update(WINEPREFIX=str(prefix), WINEDEBUG="-all", WINEDLLOVERRIDES="mscoree,mshtml=", LC_ALL="C.UTF-8")
user = prefix / "drive_c/users" / (os.environ.get("USER") or os.environ.get("LOGNAME") or "root")
INSTALLED = ["LICENSE.txt", "NOTICES.txt", "ipos.exe", "uninstall.exe"]
UNINSTALL = r"HKCU\Software\Microsoft\Windows\CurrentVersion\Uninstall\ipos"
checks = 0


def wine(*words: str) -> str:
    made = subprocess.run(["wine", *words], capture_output=True, text=True, errors="replace", timeout=300)
    subprocess.run(["wineserver", "-w"], timeout=300)  # an uninstaller goes on in a copy of itself
    return made.stdout if made.returncode == 0 else f"exit code {made.returncode}: {made.stdout}{made.stderr}"


def expect(what: str, holds: bool, seen: object = "") -> None:
    global checks
    checks += 1
    if not holds:
        sys.exit(f"failed: {what}: {seen}")


def set_path(text: str, kind: str) -> None:
    wine("reg", "add", r"HKCU\Environment", "/v", "Path", "/t", kind, "/d", text, "/f")


def exported(key: str) -> str:
    wine("reg", "export", key, str(folder / "registry"), "/y")
    return (folder / "registry").read_text(encoding="utf-16")


def path() -> tuple[str, str] | None:
    found = re.search(r'^"Path"=hex\(2\):([0-9a-f,\\\s]*)', exported(r"HKCU\Environment"), re.M | re.I)
    if not found:
        return None
    return "REG_EXPAND_SZ", bytes.fromhex(re.sub(r"[^0-9a-f]", "", found[1])).decode("utf-16-le").rstrip("\0")


def registry() -> dict[str, str]:
    """All that HKCU has, without what wine itself keeps of its start menu and its desktop."""
    keys = {part.split("]")[0]: part for part in exported("HKCU").split("\n[")}
    return {name: part.strip() for name, part in keys.items() if "\\Software\\Wine" not in name and "\\Explorer" not in name
            and not part.strip().endswith("CurrentVersion\\Uninstall]")}  # the list itself, which every Windows has


def files() -> set[str]:
    return {str(file.relative_to(prefix)) for file in prefix.rglob("*") if file.is_file() or file.is_symlink()}


def differences(one: dict, other: dict) -> list:
    return [(name, one.get(name), other.get(name)) for name in {*one, *other} if one.get(name) != other.get(name)]


if "exit code" in wine("cmd", "/c", "exit"):
    skip("wine does not start")
user, = (home for home in (prefix / "drive_c/users").iterdir() if home.name != "Public")
local = user / "AppData/Local"
subprocess.run([sys.executable, ROOT / "packaging/windows/setup.py", program, folder / "made"], check=True)
setup, = (folder / "made").glob("*-setup.exe")
checksum = hashlib.sha256(setup.read_bytes()).hexdigest().upper()
for manifest in ("winget/ipos.ipos.installer.yaml", "chocolatey/tools/chocolateyinstall.ps1"):
    text = (folder / "made" / manifest).read_text(encoding="utf-8")
    expect(f"{manifest} has the installer's name and checksum", setup.name in text and checksum in text, text)
expect("every place of the templates is filled", not [file for file in (folder / "made").glob("*/**/*") if file.is_file()
       and re.search(r"@\w+@", file.read_text(encoding="utf-8"))])
expect("the same bytes a second time", subprocess.run([sys.executable, ROOT / "packaging/windows/setup.py", program, folder / "again"],
       check=True).returncode == 0 and (folder / "again" / setup.name).read_bytes() == setup.read_bytes())

# A user who has a long PATH of the kind with names, and another program for TOML.
LONG = r"%USERPROFILE%\bin;" + ";".join(rf"C:\tools\Größe {number}" for number in range(150))
set_path(LONG, "REG_EXPAND_SZ")
wine("reg", "add", r"HKCU\Software\Classes\.toml", "/ve", "/d", "editor.toml", "/f")
before, files_before = registry(), files()
expect("PATH is longer than texts of NSIS", len(LONG) > 2 * 1024)

expect("installs", wine(str(setup), "/S") == "")
place = local / "Programs/ipos"
expect("files", sorted(file.name for file in place.iterdir()) == INSTALLED, list(place.iterdir()))
expect("the program is whole", (place / "ipos.exe").read_bytes() == program.read_bytes())
expect("notices", "NSIS" in (place / "NOTICES.txt").read_text(encoding="utf-8"))
windows_place = "C:" + str(place).split("drive_c")[1].replace("/", "\\")
expect("PATH has the folder at its end, and all else as before", path() == ("REG_EXPAND_SZ", f"{LONG};{windows_place}"), path())
expect("start menu", any(file.endswith("Start Menu/Programs/ipos.lnk") for file in files()))
expect("a session is opened by ipos", "ipos.session" in wine("reg", "query", r"HKCU\Software\Classes\.ipos", "/ve"))
expect("TOML stays with its editor", "editor.toml" in exported(r"HKCU\Software\Classes\.toml"), exported(r"HKCU\Software\Classes\.toml"))
expect("and ipos is offered", "ipos.plant" in wine("reg", "query", r"HKCU\Software\Classes\.toml\OpenWithProgids"))
command = wine("reg", "query", r"HKCU\Software\Classes\ipos.plant\shell\open\command", "/ve")
expect("by a command with both names in quotes", f'"{windows_place}\\ipos.exe" serve "%1" --open' in command, command)
expect("version", re.search(r"DisplayVersion\s+REG_SZ\s+\d+\.\d+\.\d+", wine("reg", "query", UNINSTALL)) is not None)

expect("installs over itself", wine(str(setup), "/S") == "")
expect("PATH has the folder once", path() == ("REG_EXPAND_SZ", f"{LONG};{windows_place}"), path())

(local / "ipos").mkdir()
(local / "ipos/layout.json").write_text("{}")
(place / "own.txt").write_text("of the user")
expect("uninstalls", wine(str(place / "uninstall.exe"), "/S") == "")
expect("the registry is as before", registry() == before, differences(before, registry()))
left = {name for name in files() - files_before if not name.endswith(".reg")}
kept = {str((local / "ipos/layout.json").relative_to(prefix)), str((place / "own.txt").relative_to(prefix))}
expect("only what the user made is left", left == kept, left ^ kept)

# Another folder, no PATH at all, and what the page has kept goes, too.
(place / "own.txt").unlink()
place.rmdir()
wine("reg", "delete", r"HKCU\Environment", "/v", "Path", "/f")
before = registry()
other = prefix / "drive_c/Geräte/ipos"
expect("installs elsewhere", wine(str(setup), "/S", r"/D=C:\Geräte\ipos") == "")
expect("files elsewhere", sorted(file.name for file in other.iterdir()) == INSTALLED)
expect("PATH is that folder", path() == ("REG_EXPAND_SZ", r"C:\Geräte\ipos"), path())
seen = wine("cmd", "/c", "ipos", "--version")  # wine's own console looks at the beginning of a long PATH only
expect("a new console finds ipos", seen.startswith("ipos "), seen)
expect("uninstalls with all", wine(str(other / "uninstall.exe"), "/S", "/KEPT") == "")
expect("no PATH, as before", path() is None, path())
expect("the registry is as before again", registry() == before, differences(before, registry()))
expect("nothing is left", not other.exists() and not place.exists() and not (local / "ipos").exists())
subprocess.run(["wineserver", "-k"])
print(f"{setup.stat().st_size} bytes, {checks} checks")
shutil.rmtree(folder, ignore_errors=True)
