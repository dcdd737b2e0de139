"""The pytest plugin, tried in runs of pytest of their own."""

import shutil

import pytest

from conftest import HERE, PACKAGE

ARGUMENTS = ("-p", "no:cacheprovider")  # the plugin itself is found by what stands beside the package


@pytest.fixture
def folder(pytester, monkeypatch):
    monkeypatch.setenv("PYTHONPATH", str(PACKAGE))
    for name in ("line.toml", "SAW.IPC"):
        shutil.copy(HERE / name, pytester.path)
    return pytester


def test_fixture_and_marker(folder):
    folder.makepyfile(
        """
        import pytest

        @pytest.mark.plant("line.toml")
        def test_saw(plant):
            assert plant.run("1s") and plant["saw"]["lCount"] > 50

        def test_the_only_plant_of_the_folder(plant):
            assert plant.time == 0 and list(plant) == ["saw", "belt"]

        @pytest.mark.plant("line.toml", seeds=[1, 2, 3], speed=20)
        def test_seeds(plant):
            plant.run("10ms")

        @pytest.mark.plant(text='[[station]]\\nname = "a"\\nunit = "mdxb"\\n')
        def test_text(plant):
            assert "a" in plant
        """
    )
    folder.runpytest_subprocess(*ARGUMENTS, "-v").assert_outcomes(passed=6)


def test_a_failure_shows_journal_and_frames(folder):
    folder.makepyfile(
        """
        import pytest

        @pytest.mark.plant("line.toml")
        def test_saw(plant):
            plant.run("1s")
            plant["saw"].raise_fault(26)
            plant.run("100ms")
            assert plant["saw"].fault == 0
        """
    )
    result = folder.runpytest_subprocess(*ARGUMENTS, "--ipos-artifacts=kept")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*journal of the plant*", "*saw: fault: *", "*last frames of sbus*", "*400#*from saw*"])
    kept = list((folder.path / "kept").iterdir())
    assert len(kept) == 1
    assert "fault" in (kept[0] / "journal.txt").read_text()
    assert "400#" in (kept[0] / "sbus.txt").read_text()
    rows = (kept[0] / "signals.csv").read_text().splitlines()
    assert rows[0].startswith("time [s],saw.speed [rpm]") and len(rows) == 1102
    import ipos

    with ipos.Plant(folder.path / "line.toml") as plant:
        plant.restore((kept[0] / "state.ipos").read_bytes())
        assert plant["saw"].fault == 26 and plant.time == pytest.approx(1.1)


def test_toml_files_are_tests_with_the_text_of_ipos_test(folder):
    (folder.path / "saw.test.toml").write_text(
        'plant = "line.toml"\n[[expect]]\nstation = "saw"\nvariable = "lCount"\nwithin = "1s"\nequals = 5\n'
    )
    (folder.path / "wrong.test.toml").write_text(
        'plant = "line.toml"\n[[expect]]\nstation = "saw"\nvariable = "lCount"\nwithin = "100ms"\nequals = 1000\n'
    )
    result = folder.runpytest_subprocess(*ARGUMENTS)
    result.assert_outcomes(passed=1, failed=1)
    result.stdout.fnmatch_lines(["*lCount of saw did not become 1000 from 0 ms to 100 ms*"])


def test_without_the_program_the_other_tests_run(folder, monkeypatch):
    # A wheel alone: no program on the path, none named, no build beside the package.
    package = folder.path / "alone"
    shutil.copytree(PACKAGE, package, ignore=shutil.ignore_patterns("__pycache__", "build", "*.egg-info"))
    monkeypatch.setenv("PYTHONPATH", str(package))
    monkeypatch.setenv("PATH", str(folder.path))
    monkeypatch.delenv("IPOS", raising=False)
    (folder.path / "saw.test.toml").write_text('plant = "line.toml"\n')
    folder.makepyfile("import pytest\n@pytest.mark.plant('line.toml')\ndef test_other(plant): plant.run('1ms')\n")
    result = folder.runpytest_subprocess(*ARGUMENTS, "-rs")
    result.assert_outcomes(passed=1, skipped=1)
    result.stdout.fnmatch_lines(["*need the program ipos: on the path, by --ipos-program, or by IPOS*"])
    result = folder.runpytest_subprocess(*ARGUMENTS, "--ipos-program", "/no/ipos")
    result.stdout.fnmatch_lines(["*the program /no/ipos cannot be started: No such file or directory*"])


def test_several_workers(folder):
    pytest.importorskip("xdist")
    folder.makepyfile(
        """
        import pytest

        @pytest.mark.plant("line.toml", seeds=range(8))
        def test_seeds(plant):
            plant.run("100ms")
        """
    )
    (folder.path / "saw.test.toml").write_text(
        'plant = "line.toml"\n[[expect]]\nstation = "saw"\nvariable = "lCount"\nwithin = "1s"\nequals = 5\n'
    )
    folder.runpytest_subprocess(*ARGUMENTS, "-p", "xdist", "-n", "2").assert_outcomes(passed=9)


def test_a_plant_with_mistakes_says_where(folder):
    folder.makepyfile(
        """
        import pytest

        @pytest.mark.plant(text='[[station]]\\nname = "a"\\nunit = "mdxx"\\n')
        def test_text(plant):
            pass
        """
    )
    result = folder.runpytest_subprocess(*ARGUMENTS)
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*3:8: 'mdxx' is no unit type*"])
    result.stdout.no_fnmatch_line("*_fail_to_open*")  # the mistake, not the way to it
