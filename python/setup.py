"""Puts the C library into the wheel: the one that IPOS_PLANT_LIBRARY names, or that of build/release or build/dev; when
there is none it is built with CMake. With a DLL for Windows (build/windows/lib/ipos_plant.dll) the wheel is one for Windows, also
where it is made on Linux."""

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
WINDOWS_LIBRARY = "ipos_plant.dll"


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


def name_in_wheel(library: Path) -> str:
    return WINDOWS_LIBRARY if library.suffix == ".dll" else LIBRARY


class BuildWithLibrary(build_py):
    def run(self) -> None:
        super().run()
        package = Path(self.build_lib) / "ipos"
        library = find_library()
        name = name_in_wheel(library)
        shutil.copy(library.resolve(), package / name)
        # The licences of what the library contains.
        notices = SOURCE / "cmake/notices.cmake"
        part = "windows-library" if name == WINDOWS_LIBRARY else "library"
        subprocess.run(["cmake", f"-DIN={part}", f"-DOUT={(package / 'NOTICES.txt').resolve()}", "-P", notices], check=True)


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
        library = find_library().resolve()
        is_windows = name_in_wheel(library) == WINDOWS_LIBRARY
        return "py3", "none", "win_amd64" if is_windows else oldest_system(library, super().get_tag()[2])


class WithLibrary(Distribution):
    def has_ext_modules(self) -> bool:
        return True


setup(distclass=WithLibrary, cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": Wheel})
