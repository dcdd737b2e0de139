"""The pytest plugin: the fixture `plant`, its marker, and *.test.toml files as tests.

    @pytest.mark.plant("line.toml")
    def test_saw(plant):
        plant.run("1s")
        assert plant["saw"]["lCount"] > 0

Several files, or seeds=range(10), make a test of each. Without the marker the plant is the one that the ini option
`ipos_plant` names, or the only plant file in the folder of the test.
"""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any, Iterator, Optional

import pytest

from ._library import PlantError
from ._program import find_program
from .plant import Plant

_ENDING = ".test.toml"
_FRAMES = 8  # of each bus in a report
_COLUMNS = 50  # variables of a station in an artifact


def pytest_addoption(parser: pytest.Parser) -> None:
    group = parser.getgroup("ipos")
    group.addoption("--ipos-program", metavar="PATH", help="the program ipos that runs *.test.toml")
    group.addoption(
        "--ipos-artifacts", metavar="DIR", help="write journal, frames and state of the plant of every failed test into DIR"
    )
    parser.addini("ipos_plant", "plant file of tests without the marker plant, relative to the root folder")
    parser.addini("ipos_collect", "collect *.test.toml files as tests", type="bool", default=True)


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line(
        "markers",
        "plant(*files, seeds=None, **options): the plant of the fixture `plant`, relative to the test's file; "
        "options are those of ipos.Plant",
    )


# --- the fixture


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    if "plant" not in metafunc.fixturenames:
        return
    marker = metafunc.definition.get_closest_marker("plant")
    if marker is None:
        return
    options = dict(marker.kwargs)
    seeds = options.pop("seeds", None)
    cases, names = [], []
    for file in marker.args or (None,):
        for seed in (None,) if seeds is None else seeds:
            cases.append({"file": file, **options, **({} if seed is None else {"seed": seed})})
            stem = Path(str(file)).stem if file is not None else "plant"
            names.append(stem if seed is None else f"{stem}-{seed}")
    if len(cases) > 1:
        metafunc.parametrize("plant", cases, indirect=True, ids=names)


@pytest.fixture
def plant(request: pytest.FixtureRequest) -> Iterator[Plant]:
    """A plant at time 0, opened for this test alone."""
    marker = request.node.get_closest_marker("plant")
    case: dict[str, Any] = dict(getattr(request, "param", None) or (marker.kwargs if marker else {}))
    case.pop("seeds", None)
    file = case.pop("file", None) or (marker.args[0] if marker and marker.args else None)
    if file is None and "text" not in case:
        file = _default_plant(request)
    if file is not None:
        file = request.path.parent / file
    elif "folder" not in case:
        case["folder"] = request.path.parent
    try:
        made = Plant(file, **case)
    except PlantError as error:  # its mistakes, without the code of this package around them
        pytest.fail(str(error), pytrace=False)
    with made as opened:
        request.node.stash[_PLANT] = opened
        yield opened


_PLANT = pytest.StashKey[Plant]()


def _default_plant(request: pytest.FixtureRequest) -> Path:
    named = request.config.getini("ipos_plant")
    if named:
        return request.config.rootpath / named
    folder = request.path.parent
    files = [each for each in sorted(folder.glob("*.toml")) if not each.name.endswith(_ENDING) and _is_plant(each)]
    if len(files) == 1:
        return files[0]
    found = ", ".join(each.name for each in files) or "none"
    raise pytest.UsageError(f'which plant? write @pytest.mark.plant("file.toml"); the folder of {request.path.name} has {found}')


def _is_plant(path: Path) -> bool:
    return "[[station]]" in path.read_text(encoding="utf-8", errors="replace")


# --- the report of a failed test


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item: pytest.Item, call: pytest.CallInfo[None]):
    outcome = yield
    report = outcome.get_result()
    opened = item.stash.get(_PLANT, None)
    if opened is None or call.when != "call" or not report.failed or opened._closed:
        return
    try:
        _describe(item, report, opened)
    except Exception as error:  # the failure itself must not be lost
        report.sections.append(("plant", f"cannot be described: {error}"))


def _describe(item: pytest.Item, report: pytest.TestReport, opened: Plant) -> None:
    journal = "\n".join(map(str, opened.journal))
    stations = "\n".join(f"{station!r} {station.why}" for station in opened.stations.values())
    report.sections.append((f"plant at {opened.time:.3f} s", stations))
    report.sections.append(("journal of the plant", journal or "nothing"))
    frames: dict[str, list[str]] = {}
    for name, bus in opened.buses.items():
        bus.frames()
        frames[name] = [repr(frame) for frame in bus.last]
        if frames[name]:
            report.sections.append((f"last frames of {name}", "\n".join(frames[name][-_FRAMES:])))
    folder = item.config.getoption("--ipos-artifacts")
    if folder:
        place = Path(folder) / "".join(c if c.isalnum() or c in "-_." else "_" for c in item.nodeid)
        place.mkdir(parents=True, exist_ok=True)
        (place / "journal.txt").write_text(journal + "\n", encoding="utf-8")
        for name, lines in frames.items():
            (place / f"{name}.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")
        if opened.recorded:
            (place / "state.ipos").write_bytes(opened.snapshot())
            _record(opened, place)
        report.sections.append(("artifacts", str(place)))


def _record(opened: Plant, place: Path) -> None:
    """The course of the whole run: motion of every station and the variables of its program."""
    names = []
    for station in opened.stations.values():
        names += [f"{station.name}.{name}" for name in ("speed", "setpoint", "fault", *station.variables[:_COLUMNS])]
    recording = opened.replay(names)
    recording.write_csv(place / "signals.csv")
    try:
        axes = recording.plot()
    except ImportError:
        return
    axes[0].figure.savefig(place / "plot.svg")


# --- *.test.toml


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> Optional[pytest.Collector]:
    if file_path.name.endswith(_ENDING) and parent.config.getini("ipos_collect"):
        return TestFile.from_parent(parent, path=file_path)
    return None


class TestFailure(Exception):
    """What `ipos test` says."""


def _program(config: pytest.Config) -> Optional[str]:
    """The program that runs the tests; None: there is none here."""
    return config.getoption("--ipos-program") or find_program()


class TestFile(pytest.File):
    """A *.test.toml file."""

    def collect(self) -> Iterator[pytest.Item]:
        program = _program(self.config)
        if program is None:
            yield WithoutProgram.from_parent(self, name=self.path.name.removesuffix(_ENDING))
            return
        try:
            listed = subprocess.run([program, "test", str(self.path), "--list"], capture_output=True, text=True, check=False)
        except OSError as error:
            raise self.CollectError(f"the program {program} cannot be started: {error.strerror}") from None
        if listed.returncode != 0 and not listed.stdout:
            raise self.CollectError(listed.stderr.strip())
        for line in listed.stdout.splitlines():
            name, _, place = line.rpartition("  ")
            number = place.rpartition(":")[2]
            yield TestItem.from_parent(
                self, name=name.strip().rpartition("/")[2], full_name=name.strip(), line=int(number) if number.isdigit() else 1
            )


class WithoutProgram(pytest.Item):
    """The tests of a file that nothing here can run."""

    def runtest(self) -> None:
        pytest.skip("*.test.toml files need the program ipos: on the path, by --ipos-program, or by IPOS")


class TestItem(pytest.Item):
    """A test of it, run by `ipos test`."""

    def __init__(self, *, full_name: str, line: int, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.full_name, self.line = full_name, line

    def runtest(self) -> None:
        command = [_program(self.config), "test", str(self.path), "--filter", self.full_name, "--jobs", "1", "--format", "text"]
        run = subprocess.run(command, capture_output=True, text=True, check=False)
        if run.returncode != 0:
            raise TestFailure((run.stdout + run.stderr).strip())

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        if isinstance(excinfo.value, TestFailure):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int, str]:
        return self.path, self.line - 1, self.full_name
