"""The program `ipos`, for what runs verbs of it."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Optional


def find_program() -> Optional[str]:
    """That of the variable IPOS, of the wheel, of a build of the sources, or on the PATH; None: there is none here."""
    if named := os.environ.get("IPOS"):
        return named
    here = Path(__file__).resolve().parent
    for place in (here / "ipos-program", *(here.parent.parent / "build" / build / "tools" / "ipos" for build in ("release", "dev"))):
        if place.is_file():
            return str(place)
    return shutil.which("ipos")
