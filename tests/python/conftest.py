"""The package is tested where it lies, with the entry points an installed one has; ctest names the library of its build."""

import sys
import tempfile
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python"
sys.path.insert(0, str(PACKAGE))

_installed = tempfile.TemporaryDirectory()
_info = Path(_installed.name) / "ipos-0.1.0.dist-info"
_info.mkdir()
(_info / "METADATA").write_text("Metadata-Version: 2.1\nName: ipos\nVersion: 0.1.0\n")
(_info / "entry_points.txt").write_text("[can.interface]\nipos = ipos.can:IposBus\n")
sys.path.insert(0, _installed.name)

import ipos  # noqa: E402

pytest_plugins = ["pytester"]

HERE = Path(__file__).resolve().parent
LINE = str(HERE / "line.toml")


@pytest.fixture
def line():
    with ipos.Plant(LINE) as plant:
        yield plant
