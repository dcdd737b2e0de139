"""The package is tested where it lies, with the entry points that stand beside it; ctest names the library of its build."""

import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "python"
sys.path.insert(0, str(PACKAGE))

import ipos  # noqa: E402

pytest_plugins = ["pytester"]

HERE = Path(__file__).resolve().parent
LINE = str(HERE / "line.toml")


@pytest.fixture
def line():
    with ipos.Plant(LINE) as plant:
        yield plant
