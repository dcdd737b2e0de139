"""FMUs of ipos on a CAN line outside: connected directly, and by the line of a plant as a bus simulation."""

import tomllib
import zipfile

import pytest

from fmu import SOURCE, Fmu, ipos, write_fmu
from network import Ear, Network, Terminal

SCOM = SOURCE / "examples/scom/scom.toml"


def station_alone(name, folder):
    """One station of the example on a line that goes on outside."""
    head, *stations = SCOM.read_text().split("[[station]]")
    station, = [own for own in (each.split("[[expect]]")[0] for each in stations) if f'name = "{name}"' in own]
    folder.mkdir()
    for program in SCOM.parent.glob("*.IPC"):
        (folder / program.name).write_bytes(program.read_bytes())
    (folder / "p.toml").write_text(head + 'port = "fmi"\n[[station]]' + station)
    return Fmu(write_fmu(folder / "p.toml", folder / "p.fmu", 3), folder / "unpacked").make(events=True)


def check_watch_windows(*stations):
    """The manual's, as the example expects them after a second (1053 1610 figures 36 and 37)."""
    count = 0
    for expect in tomllib.loads(SCOM.read_text())["expect"]:
        instance = stations[int(expect["station"][-1]) - 1]
        name = f"{expect['station']}.{expect['variable']}"
        assert instance.get(name) & 0xFFFFFFFF == expect["equals"], name
        count += 1
    assert count > 20


def line_alone(folder, terminals, *more):
    fmu = Fmu(write_fmu(SCOM, folder / "bus.fmu", 3, "--bus", "sbus", "--terminals", terminals, *more), folder / "bus")
    return fmu.make(events=True)


def test_two_stations_meet_directly(tmp_path):
    one, two = (station_alone(f"unit{n}", tmp_path / str(n)) for n in (1, 2))
    Network((Terminal(one, "sbus"), Terminal(two, "sbus"))).run(1.0)
    check_watch_windows(one, two)


def test_two_stations_meet_by_our_line(tmp_path):
    one, two = (station_alone(f"unit{n}", tmp_path / str(n)) for n in (1, 2))
    bus = line_alone(tmp_path, 3)
    ear = Ear()
    Network((Terminal(one, "sbus"), Terminal(bus, "sbus.node1")), (Terminal(two, "sbus"), Terminal(bus, "sbus.node2")),
            (ear, Terminal(bus, "sbus.node3"))).run(1.0)
    check_watch_windows(one, two)
    # Each frame has eight bytes and the operation 24: unit1 sends every 100 ms, unit2 every 120 ms.
    frames = [data for _, data in ear.heard]
    assert all(len(frame) == 24 and frame[0] == 0x10 for frame in frames)
    assert [sum(frame[8] == low and frame[9] == 4 for frame in frames) for low in (0, 1)] == [pytest.approx(10, abs=1), pytest.approx(8, abs=1)]
    assert bus.get("sbus.count") == len(frames)


def test_its_files(tmp_path):
    out = write_fmu(SCOM, tmp_path / "bus.fmu", 3, "--bus", "sbus", "--terminals", 3)
    archive = zipfile.ZipFile(out)
    assert 'isBusSimulationFMU="true"' in archive.read("extra/org.fmi-standard.fmi-ls-bus/fmi-ls-manifest.xml").decode()
    terminals = archive.read("terminalsAndIcons/terminalsAndIcons.xml").decode()
    assert [f'name="sbus.node{n}"' in terminals for n in (1, 2, 3, 4)] == [True, True, True, False]
    assert terminals.count('memberName="BusNotifications"') == 3
    description = archive.read("modelDescription.xml").decode()
    assert description.count('intervalVariability="countdown"') == 3 and "fixedInternalStepSize" not in description
    assert not any(name.endswith(".ipx") for name in archive.namelist()), "no programs"
    fmu = Fmu(out, tmp_path / "u")
    assert fmu.variables["sbus.load"].causality == "output"
    assert {name.split(".")[0] for name in fmu.variables} == {"time", "sbus"}


def test_what_it_does_not_take(tmp_path):
    def code(*arguments):
        return ipos("fmu", SCOM, "-o", tmp_path / "x.fmu", *arguments)

    done = code("--bus", "nobody")
    assert done.returncode == 64 and "the plant has sbus" in done.stderr
    for more in (["--fmi", "2"], ["--station", "unit1"], ["--signals", "unit1.speed"], ["--sources"], ["--terminals", "0"], ["--terminals", "65"]):
        assert code("--bus", "sbus", *more).returncode == 64, more
    (tmp_path / "f.toml").write_text('[[bus]]\nname = "sbus"\nkind = "can"\n[[station]]\nname = "u"\nunit = "mdxb"\nsbus = "sbus"\n'
                                     '[[fault]]\nbus = "sbus"\nkind = "drop"\nstation = "u"\n')
    done = ipos("fmu", tmp_path / "f.toml", "-o", tmp_path / "x.fmu", "--bus", "sbus")
    assert done.returncode == 0 and "f.toml:8:1: the fault is left out: it needs the station 'u'" in done.stderr
