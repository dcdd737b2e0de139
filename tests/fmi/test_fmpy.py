"""FMPy, which is not of Debian: IPOS_FMPY names the folder with its package. Validation of the FMUs of all examples, and runs."""

import os
import sys

import pytest

from fmu import SOURCE, as_shown, trace, write_fmu

PATH = os.environ.get("IPOS_FMPY", "")
if not PATH:
    pytest.skip("IPOS_FMPY names no folder with FMPy's package", allow_module_level=True)
sys.path.insert(0, PATH)
fmpy = pytest.importorskip("fmpy", reason="IPOS_FMPY: FMPy needs numpy, lxml, lark, attr and msgpack")

PLANTS = sorted(path for path in SOURCE.glob("examples/*/*.toml") if not path.name.endswith((".test.toml", ".campaign.toml")))


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("plant", PLANTS, ids=lambda path: path.stem)
def test_it_has_no_findings(plant, version, tmp_path):
    from fmpy.validation import validate_fmu
    assert validate_fmu(str(write_fmu(plant, tmp_path / "a.fmu", version))) == []


@pytest.mark.parametrize("more", [[], ["--bus", "sbus", "--terminals", "3"]], ids=["node", "bus"])
def test_a_terminal_is_as_the_schema_wants_it(more, tmp_path):
    import zipfile
    from lxml import etree
    from fmpy.validation import validate_fmu
    (tmp_path / "p.toml").write_text('[[bus]]\nname = "sbus"\nkind = "can"\nport = "fmi"\n'
                                     '[[station]]\nname = "u"\nunit = "mdxb"\nsbus = "sbus"\n')
    out = write_fmu(tmp_path / "p.toml", tmp_path / "a.fmu", 3, *more)
    assert validate_fmu(str(out)) == []
    text = zipfile.ZipFile(out).read("terminalsAndIcons/terminalsAndIcons.xml")
    schema = etree.XMLSchema(file=f"{PATH}/fmpy/schema/fmi3/fmi3TerminalsAndIcons.xsd")
    schema.assertValid(etree.fromstring(text))


@pytest.mark.parametrize("version", [2, 3])
@pytest.mark.parametrize("example", ["hoist", "scom", "winder", "gateway", "canopen"])
def test_it_is_the_run_of_ipos_to_the_digit(example, version, tmp_path):
    plant = SOURCE / "examples" / example / f"{example}.toml"
    rows = trace(plant, 1, ["*.speed", "*.status", "*.D*", "*.PI?", "*.position*"], tmp_path)
    fmu = str(write_fmu(plant, tmp_path / "a.fmu", version))
    outputs = {each.name for each in fmpy.read_model_description(fmu).modelVariables if each.causality == "output"}
    names = [name for name in rows[0] if name in outputs]
    for interval in (1e-3, 1e-2):
        result = fmpy.simulate_fmu(fmu, stop_time=1.0, output_interval=interval, output=names)
        assert len(result) == round(1 / interval) + 1
        for values in result[1:]:
            row = rows[round(values["time"] * 1000) - 1]
            for name in names:
                assert as_shown(values[name], row[name]) == row[name], (name, values["time"])
