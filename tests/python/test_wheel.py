"""The package installs from its folder with pip, without an index, into an empty environment, and works there."""

import configparser
import os
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
PACKAGE = HERE.parents[1] / "python"

SCRIPT = """
import importlib.metadata, sys
import ipos
assert ipos.__file__.startswith(sys.prefix), ipos.__file__
names = {(each.group, each.name) for each in importlib.metadata.distribution("ipos").entry_points}
assert names == {("pytest11", "ipos"), ("can.interface", "ipos")}, names
notices = (__import__("pathlib").Path(ipos.__file__).parent / "NOTICES.txt").read_text()
assert all(name in notices for name in ("{fmt}", "toml++", "GCC runtime")) and "preact" not in notices, notices[:200]
with ipos.Plant(sys.argv[1]) as plant:
    plant.run("1s")
    tag, = importlib.metadata.distribution("ipos").read_text("WHEEL").split("Tag: ")[1:]
    print(plant["saw"]["lCount"], plant.trace_hash, __import__("pathlib").Path(ipos.__file__).parent / "libipos_plant.so", tag.strip())
"""


def run(*command, **keys):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=300, **keys)
    assert done.returncode == 0, f"{command}\n{done.stdout}\n{done.stderr}"
    return done.stdout


def test_a_source_folder_shows_what_the_wheel_has():
    tomllib = pytest.importorskip("tomllib")
    project = tomllib.loads((PACKAGE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    info = PACKAGE / f"ipos-{project['version']}.dist-info"
    points = configparser.ConfigParser(delimiters=("=",))
    points.read(info / "entry_points.txt", encoding="utf-8")
    assert {group: dict(points[group]) for group in points.sections()} == project["entry-points"]
    assert f"Version: {project['version']}\n" in (info / "METADATA").read_text(encoding="utf-8")


def sources_in(folder):
    # pip would write beside the sources.
    source = folder / "python"
    shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info", "*.so"))
    return source


def building(library):
    return {**os.environ, "IPOS_SOURCE": str(PACKAGE.parent), "IPOS_PLANT_LIBRARY": str(library),
            "PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_CONFIG_FILE": os.devnull}  # fmt: skip


# What a Python for Windows finds in its wheel; no such Python is in Debian. tests/embedding/windows_library.sh makes it with the real
# DLL and drives that.
def test_a_wheel_for_windows(tmp_path):
    pytest.importorskip("setuptools")
    pytest.importorskip("wheel")
    library = tmp_path / "ipos_plant.dll"
    library.write_bytes(b"MZ")
    run(sys.executable, "-m", "pip", "wheel", "-q", "--no-index", "--no-build-isolation", "--no-deps", "-w", tmp_path / "out", ".",
        env=building(library), cwd=sources_in(tmp_path))  # fmt: skip
    (wheel,) = (tmp_path / "out").iterdir()
    assert wheel.name.endswith("-py3-none-win_amd64.whl")
    with zipfile.ZipFile(wheel) as packed:
        names = set(packed.namelist())
        assert packed.read("ipos/ipos_plant.dll") == b"MZ"
        info = next(name for name in names if name.endswith(".dist-info/WHEEL")).rpartition("/")[0]
        assert "Tag: py3-none-win_amd64\n" in packed.read(f"{info}/WHEEL").decode()
        points = configparser.ConfigParser(delimiters=("=",))
        points.read_string(packed.read(f"{info}/entry_points.txt").decode())
        assert dict(points["pytest11"]) == {"ipos": "ipos.pytest_plugin"} and dict(points["can.interface"]) == {"ipos": "ipos.can:IposBus"}
        notices = packed.read("ipos/NOTICES.txt").decode()
        assert all(name in notices for name in ("{fmt}", "toml++", "GCC runtime", "mingw-w64", "winpthreads")), notices[:200]
        ours = {f"ipos/{each.name}": each.read_bytes() for each in (PACKAGE / "ipos").iterdir() if each.is_file()}
        assert {name: packed.read(name) for name in ours} == ours
    assert {name for name in names if name.startswith("ipos/")} == {*ours, "ipos/ipos_plant.dll", "ipos/NOTICES.txt"}


LOADING = """
import importlib.util, os, sys, types
system = types.ModuleType("os")
system.__dict__.update(vars(os), name="nt")
spec = importlib.util.spec_from_file_location("loaded", sys.argv[1])
sys.modules["os"] = system  # for this module alone: others have theirs already
spec.loader.exec_module(importlib.util.module_from_spec(spec))
"""


def test_on_windows_it_loads_the_dll(tmp_path):
    alone = {name: value for name, value in os.environ.items() if name != "IPOS_PLANT_LIBRARY"}
    module = shutil.copy(PACKAGE / "ipos" / "_library.py", tmp_path)
    done = subprocess.run([sys.executable, "-c", "import ctypes, pathlib\n" + LOADING, module], capture_output=True, text=True, env=alone)
    assert f"no ipos_plant.dll; tried\n  {tmp_path}/ipos_plant.dll\n" in done.stderr, done.stderr


@pytest.mark.skipif("IPOS_PLANT_LIBRARY" not in os.environ, reason="IPOS_PLANT_LIBRARY names the library to put in")
def test_pip_installs_it_without_an_index(tmp_path, line):
    pytest.importorskip("setuptools")
    pytest.importorskip("wheel")
    # setuptools is the one of the system: without an index none can be fetched.
    run(sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", tmp_path / "venv")
    python = tmp_path / "venv" / "bin" / "python"
    run(sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-index", "--no-build-isolation", "--no-deps",
        sources_in(tmp_path), env=building(os.environ["IPOS_PLANT_LIBRARY"]), cwd=tmp_path)  # fmt: skip
    alone = {name: value for name, value in os.environ.items() if name not in ("IPOS_PLANT_LIBRARY", "PYTHONPATH")}
    count, trace_hash, library, tag = run(python, "-c", SCRIPT, HERE / "line.toml", env=alone, cwd=tmp_path).split()
    line.run("1s")
    assert (int(count), trace_hash) == (line["saw"]["lCount"], line.trace_hash)
    # By PEP 600: what it takes of the system is the C library, and no newer one than its name says.
    if (objdump := shutil.which("objdump")) and sys.platform == "linux":
        needed = [words[1] for words in map(str.split, run(objdump, "-p", library).splitlines()) if words[:1] == ["NEEDED"]]
        own = all(re.fullmatch(r"(libc|libm|ld-linux-[\w-]+)\.so\.\d+", name) for name in needed)
        assert own == ("-manylinux_2_" in tag), (tag, needed)  # a library with a sanitizer takes more
        newest = max(int(minor) for minor in re.findall(r"GLIBC_2\.(\d+)", run(objdump, "-T", library)))
        assert not own or re.fullmatch(rf"py3-none-manylinux_2_{newest}_\w+", tag), tag
