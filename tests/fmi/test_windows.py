"""One FMU for both platforms: its DLL under wine gives what its library for Linux gives, to the last digit."""

import os
import shutil
import subprocess

import pytest

from fmu import SOURCE, Fmu, write_fmu

DLL = SOURCE / "build/windows/lib/ipos_fmu.dll"
COMPILER = "x86_64-w64-mingw32-gcc-posix"
if not DLL.exists():
    pytest.skip("for Windows: there is no ipos_fmu.dll, ./dev windows builds it", allow_module_level=True)
for tool in ("wine", COMPILER, "gcc"):
    if shutil.which(tool) is None:
        pytest.skip(f"for Windows: there is no {tool}", allow_module_level=True)
WINE = {**os.environ, "WINEDEBUG": "-all", "WINEDLLOVERRIDES": "mscoree,mshtml=", "WINEPREFIX": str(SOURCE / "build/windows/wine")}
if subprocess.run(["wine", "cmd", "/c", "exit"], env=WINE, capture_output=True, timeout=300).returncode != 0:
    pytest.skip("for Windows: wine does not start", allow_module_level=True)


@pytest.mark.parametrize("version", [2, 3])
def test_both_libraries_of_one_fmu_do_the_same(version, tmp_path, monkeypatch):
    libraries = tmp_path / "libraries"
    libraries.mkdir()
    for library in (DLL, os.path.join(os.environ["IPOS_FMU_LIBRARIES"], "libipos_fmu.so")):
        shutil.copy(library, libraries)
    monkeypatch.setenv("IPOS_FMU_LIBRARIES", str(libraries))
    folder = tmp_path / "Säge 1"  # letters that not every code page has
    fmu = Fmu(write_fmu(SOURCE / "examples/hoist/hoist.toml", tmp_path / "hoist.fmu", version), folder)
    source = SOURCE / "tests/fmi/client.c"
    flags = ["-std=c11", "-O1", "-Wall", "-Wextra", "-Werror"]
    subprocess.run(["gcc", *flags, "-o", tmp_path / "client", source, "-ldl"], check=True)
    subprocess.run([COMPILER, *flags, "-o", tmp_path / "client.exe", source], check=True)
    real = "Real" if version == 2 else "Float64"
    references = [str(each.reference) for each in fmu.variables.values() if each.kind == real and each.causality == "output"]
    assert len(references) > 5
    names = ("linux64", "win64") if version == 2 else ("x86_64-linux", "x86_64-windows")
    shutil.copy(folder / f"binaries/{names[1]}/hoist.dll", tmp_path / "hoist.dll")
    resources = (folder / "resources").as_uri() if version == 2 else str(folder / "resources")
    uri = resources.replace("file:///", "file:///Z:/") if version == 2 else "Z:" + resources
    linux = subprocess.run([tmp_path / "client", folder / f"binaries/{names[0]}/hoist.so", str(version), fmu.token, resources, "100", *references],
                           capture_output=True, text=True, check=True)
    windows = subprocess.run(["wine", "client.exe", "hoist.dll", str(version), fmu.token, uri, "100", *references], cwd=tmp_path, env=WINE,
                             capture_output=True, text=True, timeout=300)
    assert windows.returncode == 0, windows.stderr
    rows = windows.stdout.splitlines()
    assert len(rows) == 100 and len(set(rows)) > 10
    assert rows == linux.stdout.splitlines()
