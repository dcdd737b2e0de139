"""Puts the C library into the wheel: the one that IPOS_PLANT_LIBRARY names, or that of build/release or build/dev; when
there is none it is built with CMake."""

import os
import re
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


# What PEP 600 lets a wheel for any Linux take from the system; the rest is in the library.
FROM_SYSTEM = {b"libc.so.6", b"libm.so.6", b"ld-linux-x86-64.so.2", b"ld-linux-aarch64.so.1"}


def oldest_system(library: Path, platform: str) -> str:
    """The tag of PEP 600: the newest version of the C library that a function of ours is of."""
    content = library.read_bytes()
    needed = set(re.findall(rb"(?<=\0)(?:lib|ld-)[\w+-]+\.so\.[\d.]+(?=\0)", content)) - {f"{LIBRARY}.0".encode()}
    versions = [int(minor) for minor in re.findall(rb"\0GLIBC_2\.(\d+)(?:\.\d+)?(?=\0)", content)]
    if not platform.startswith("linux_") or not versions or needed - FROM_SYSTEM:
        return platform
    return platform.replace("linux_", f"manylinux_2_{max(versions)}_", 1)


class Wheel(bdist_wheel):
    """For any Python 3 of this platform."""

    def get_tag(self):
        return "py3", "none", oldest_system(find_library().resolve(), super().get_tag()[2])


class WithLibrary(Distribution):
    def has_ext_modules(self) -> bool:
        return True


setup(distclass=WithLibrary, cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": Wheel})
