"""Puts the C library into the wheel: the one that IPOS_PLANT_LIBRARY names, or that of build/release or build/dev; when
there is none it is built with CMake."""

import os
import shutil
import subprocess
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

SOURCE = Path(os.environ.get("IPOS_SOURCE", Path(__file__).resolve().parent.parent))
LIBRARY = "libipos_plant.so"


def find_library() -> Path:
    named = os.environ.get("IPOS_PLANT_LIBRARY")
    if named:
        return Path(named)
    built = [SOURCE / "build" / build / "lib" / LIBRARY for build in ("release", "dev")]
    for place in built:
        if place.is_file():
            return place
    subprocess.run(["cmake", "--preset", "release", "-DIPOS_TESTS=OFF"], cwd=SOURCE, check=True)
    subprocess.run(["cmake", "--build", "--preset", "release", "--target", "ipos_plant"], cwd=SOURCE, check=True)
    return built[0]


class BuildWithLibrary(build_py):
    def run(self) -> None:
        super().run()
        package = Path(self.build_lib) / "ipos"
        shutil.copy(find_library().resolve(), package / LIBRARY)
        # The licences of what the library contains.
        notices = SOURCE / "cmake/notices.cmake"
        subprocess.run(["cmake", "-DIN=library", f"-DOUT={(package / 'NOTICES.txt').resolve()}", "-P", notices], check=True)


class Wheel(bdist_wheel):
    """For any Python 3 of this platform."""

    def get_tag(self):
        return "py3", "none", super().get_tag()[2]


class WithLibrary(Distribution):
    def has_ext_modules(self) -> bool:
        return True


setup(distclass=WithLibrary, cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": Wheel})
