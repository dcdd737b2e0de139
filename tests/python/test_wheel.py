"""The package installs from its folder with pip, without an index, into an empty environment, and works there."""

import configparser
import os
import re
import shutil
import subprocess
import sys
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


@pytest.mark.skipif("IPOS_PLANT_LIBRARY" not in os.environ, reason="IPOS_PLANT_LIBRARY names the library to put in")
def test_pip_installs_it_without_an_index(tmp_path, line):
    pytest.importorskip("setuptools")
    pytest.importorskip("wheel")
    # pip would write beside the sources.
    source = tmp_path / "python"
    shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info", "*.so"))
    # setuptools is the one of the system: without an index none can be fetched.
    run(sys.executable, "-m", "venv", "--without-pip", "--system-site-packages", tmp_path / "venv")
    python = tmp_path / "venv" / "bin" / "python"
    building = {**os.environ, "IPOS_SOURCE": str(PACKAGE.parent), "PIP_DISABLE_PIP_VERSION_CHECK": "1", "PIP_CONFIG_FILE": os.devnull}
    run(sys.executable, "-m", "pip", "--python", python, "install", "-q", "--no-index", "--no-build-isolation", "--no-deps",
        source, env=building, cwd=tmp_path)  # fmt: skip
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
