"""FMUs that `ipos fmu` writes, in a small importer: the same run as `ipos run --trace`, in both versions."""

import re
import zipfile

import pytest

from fmu import SOURCE, Fmu, as_shown, ipos, trace, write_fmu

EXAMPLES = SOURCE / "examples"
SIGNALS = ["*.speed", "*.status", "*.fault", "*.DB00", "*.enabled", "*.position*"]


@pytest.mark.parametrize("example, version", [("hoist", 2), ("winder", 3), ("gateway", 2)])
def test_it_is_the_run_of_ipos_to_the_digit(example, version, tmp_path):
    plant = EXAMPLES / example / f"{example}.toml"
    rows = trace(plant, 1, SIGNALS, tmp_path)
    fmu = Fmu(write_fmu(plant, tmp_path / "a.fmu", version), tmp_path / "unpacked")
    names = [name for name in rows[0] if name in fmu.variables]
    assert len(names) > 5
    for step_ms in (1, 10):
        instance = fmu.make().begin()
        for ms in range(step_ms, 1001, step_ms):
            instance.step(step_ms / 1000)
            row = rows[ms - 1]
            assert row["time_ms"] == str(ms)
            for name in names:
                assert as_shown(instance.get(name), row[name]) == row[name], (name, ms)
        instance.free()


@pytest.mark.parametrize("version", [2, 3])
def test_going_back_gives_the_same_again(version, tmp_path):
    fmu = Fmu(write_fmu(EXAMPLES / "hoist" / "hoist.toml", tmp_path / "a.fmu", version), tmp_path / "unpacked")
    one, other = fmu.make().begin(), fmu.make().begin()
    for instance in (one, other):
        instance.step(0.4)
    state = one.state()
    one.step(0.3)
    end = one.get("hoist.shaft_angle")
    one.go_to(state, 0.4)
    other.step(0.3)
    one.step(0.3)
    assert one.get("hoist.shaft_angle") == end == other.get("hoist.shaft_angle")
    one.forget(state)
    one.free()
    other.free()


@pytest.mark.parametrize("version", [2, 3])
def test_a_path_may_have_blanks_and_umlauts(version, tmp_path):
    folder = tmp_path / "Anlage äöü 100% #1"
    folder.mkdir()
    (folder / "Säge 1.toml").write_bytes((EXAMPLES / "hoist" / "hoist.toml").read_bytes())
    (folder / "HOIST.IPC").write_bytes((EXAMPLES / "hoist" / "HOIST.IPC").read_bytes())
    fmu = Fmu(write_fmu(folder / "Säge 1.toml", folder / "ö.fmu", version), folder / "aus gepackt")
    instance = fmu.make().begin()
    instance.step(0.1)
    instance.free()


def test_its_files(tmp_path):
    plant = EXAMPLES / "hoist" / "hoist.toml"
    first, again = (write_fmu(plant, tmp_path / f"{n}.fmu", 2).read_bytes() for n in range(2))
    assert first == again, "the same plant gives the same bytes"
    names = zipfile.ZipFile(tmp_path / "0.fmu").namelist()
    assert names[0] == "modelDescription.xml"
    assert "binaries/linux64/hoist.so" in names and "documentation/licenses/license.txt" in names
    assert not any(name.endswith((".IPC", ".h")) for name in names), "no sources"
    write_fmu(plant, tmp_path / "s.fmu", 3, "--sources")
    names = zipfile.ZipFile(tmp_path / "s.fmu").namelist()
    assert "resources/sources/HOIST.IPC" in names and "binaries/x86_64-linux/hoist.so" in names


def test_a_line_becomes_a_terminal(tmp_path):
    (tmp_path / "p.toml").write_text('[[bus]]\nname = "sbus"\nkind = "can"\nport = "fmi"\n'
                                     '[[bus]]\nname = "rs"\nkind = "rs485"\nport = "fmi"\n'
                                     '[[station]]\nname = "u"\nunit = "mdxb"\nsbus = "sbus"\n')
    fmu = Fmu(write_fmu(tmp_path / "p.toml", tmp_path / "a.fmu", 3), tmp_path / "u")
    assert [fmu.variables[f"sbus.{name}"].kind for name in ("Rx_Data", "Tx_Clock")] == ["Binary", "Clock"]
    assert "rs.Rx_Data" not in fmu.variables
    names = zipfile.ZipFile(tmp_path / "a.fmu").namelist()
    assert {"terminalsAndIcons/terminalsAndIcons.xml", "extra/org.fmi-standard.fmi-ls-bus/fmi-ls-manifest.xml"} <= set(names)
    done = ipos("fmu", tmp_path / "p.toml", "-o", tmp_path / "b.fmu", "--fmi", "2")
    assert done.returncode == 0 and done.stderr.count("is left out: terminals are of CAN lines, with --fmi 3") == 2


def test_the_token_follows_the_content(tmp_path):
    def token(*more):
        path = write_fmu(tmp_path / "p.toml", tmp_path / "p.fmu", 2, *more)
        return re.search(r'guid="([^"]+)"', zipfile.ZipFile(path).read("modelDescription.xml").decode())[1]

    plant = '[[station]]\nname = "u"\nunit = "mdxb"\n[station.parameters]\nP130 = "1 s"\n'
    (tmp_path / "p.toml").write_text(plant)
    first = token()
    assert token() == first
    assert token("--signals", "u.H7") != first
    (tmp_path / "p.toml").write_text(plant.replace("1 s", "2 s"))
    assert token() != first


def test_stations_and_signals_are_chosen(tmp_path):
    plant = EXAMPLES / "scom" / "scom.toml"
    names = re.findall(r'name = "(\w+)"\nunit', plant.read_text().replace("  ", " ")) or ["unit1"]
    fmu = Fmu(write_fmu(plant, tmp_path / "a.fmu", 2, "--station", names[0], "--signals", f"{names[0]}.H1?"), tmp_path / "u")
    stations = {name.split(".")[0] for name in fmu.variables} - {"time", "sbus"}
    assert stations == {names[0]}
    assert fmu.variables[f"{names[0]}.H10"].causality == "output"
    assert ipos("fmu", plant, "-o", tmp_path / "b.fmu", "--station", "nobody").returncode == 64
    assert ipos("fmu", plant, "-o", tmp_path / "b.fmu", "--signals", "nothing").returncode == 64
    assert ipos("fmu", tmp_path / "none.toml", "-o", tmp_path / "b.fmu").returncode == 66
    (tmp_path / "bad.toml").write_text("[[station]]\nname = 1\n")
    assert ipos("fmu", tmp_path / "bad.toml", "-o", tmp_path / "b.fmu").returncode == 65


def test_start_values_are_those_of_the_instance(tmp_path):
    for version in (2, 3):
        fmu = Fmu(write_fmu(EXAMPLES / "winder" / "winder.toml", tmp_path / "a.fmu", version), tmp_path / str(version))
        instance = fmu.make()
        count = 0
        for name, variable in fmu.variables.items():
            if variable.start is None:
                assert variable.causality not in ("input", "parameter"), name
                continue
            start = {"true": 1.0, "false": 0.0}.get(variable.start) if variable.kind == "Boolean" else float(variable.start)
            assert instance.get(name) == start, name
            instance.set(name, {"Real": float, "Float64": float}.get(variable.kind, int)(start))
            count += 1
        assert count > 100
        instance.free()


def test_without_a_library_it_says_where_it_looked(tmp_path):
    import os
    done = ipos("fmu", EXAMPLES / "hoist" / "hoist.toml", "-o", tmp_path / "a.fmu", env={**os.environ, "IPOS_FMU_LIBRARIES": str(tmp_path)})
    assert done.returncode == 66 and str(tmp_path) in done.stderr and "libipos_fmu.so" in done.stderr
    assert not (tmp_path / "a.fmu").exists()
