"""Plants, stations, signals: the sample of the contract and every function behind it."""

import gc
import os
import subprocess
import sys
import threading
import weakref

import pytest

import ipos
from conftest import HERE, LINE


def test_the_sample_of_the_contract(monkeypatch):
    monkeypatch.chdir(HERE)
    data = bytes([1, 2, 3])
    with ipos.Plant("line.toml") as plant:
        assert plant.run("1s") is True
        saw = plant["saw"]
        assert plant.run(until=lambda: saw["lCount"] > 5, limit="10s") is True
        # A count every 10 ms and a little more for its commands.
        assert 90 <= saw["lCount"] <= 100
        assert saw["TrCycl.Result"] > 0  # what of the line is free for others (1053 1610 p. 50)
        assert saw["H430"] == saw["lSteps[1]"] > 0
        saw["lCount"] = 5
        assert saw["lCount"] == 5
        saw.parameters["P130"] = "2.5 s"
        assert saw.parameters["P130"].text == "2.500 s"
        assert saw.parameters["P130"] == 2500
        saw.inputs["DI01"] = True
        assert saw.inputs["DI01"] is True
        assert saw.outputs["DO01"] in (True, False)
        saw.analog["AI1"] = "5 V"
        assert saw.analog["AI1"] == 5.0 and saw.analog["AI1"].text == "5 V"
        assert isinstance(saw.speed, float) and isinstance(saw.position, int)
        assert saw.fault == 0 and saw.status_word & 1 and saw.enabled and saw.why == "enabled"
        assert plant.time == plant.time_us / 1e6
        assert isinstance(plant.journal, list) and len(plant.trace_hash) == 16
        snapshot = plant.snapshot()
        plant.restore(snapshot)
        bus = plant.buses["sbus"]
        bus.send(0x20B, data)
        plant.run("10ms")
        frame = [each for each in bus.frames() if each.id == 0x20B][-1]
        assert frame.data == data and plant.time - 0.01 < frame.time < plant.time
        assert 0 < bus.load < 100 and bus.lost == 0
        assert bus.frames() == []


def test_the_motor_says_whether_it_is_ideal():
    """As the card of the page and `ipos run --why` do: a nameplate is a motor of its own."""
    begin = '[[station]]\nname = "a"\nunit = "mdxb"\n'
    plate = '[station.motor]\npower = "1.5 kW"\nvoltage = "400 V"\nfrequency = "50 Hz"\ncurrent = "3.6 A"\nspeed = "1400 rpm"\ncos_phi = 0.79\ninertia = "24 kgcm2"\n'
    for more, ideal in (("", True), (plate, False), ('control = "real"\n', True), ('[station.load]\ntorque = "2 Nm"\n', True)):
        with ipos.Plant(text=begin + more) as plant:
            assert plant["a"].ideal_motor is ideal, more
            with pytest.raises(AttributeError):
                plant["a"].ideal_motor = True


def test_until_says_whether_the_condition_came(line):
    assert line.run(until=lambda: line.time >= 0.005, limit=1) is True
    assert line.time_us == 5000
    assert line.run(until=lambda: False, limit="3ms") is False
    assert line.time_us == 8000
    assert line.run(until=lambda: True, limit=0) is True and line.time_us == 8000


def test_times(line):
    line.run("1500us")
    assert line.time_us == 1500
    line.run(0.0005)
    assert line.time_us == 2000
    for wrong in ("1", "later", "", "-1s"):
        with pytest.raises(ValueError, match="is no time"):
            line.run(wrong)
    for wrong in (-1, 1e12, float("nan"), float("inf")):
        with pytest.raises(ValueError):
            line.run(wrong)
    for wrong in (None, [], b"1s", True):
        with pytest.raises(TypeError):
            line.run(wrong)
    with pytest.raises(TypeError):
        line.run("1s", until=lambda: True)
    with pytest.raises(TypeError):
        line.run(until=5)
    assert line.time_us == 2000


def test_a_wrong_name_says_what_there_is(line):
    with pytest.raises(KeyError, match="no station 'mill'; the plant has saw, belt"):
        line["mill"]
    with pytest.raises(KeyError, match="no variable 'lNone'; it has .*lCount"):
        line["saw"]["lNone"]
    with pytest.raises(KeyError, match="no variable 'lCount'; it has H0"):
        line["belt"]["lCount"]
    with pytest.raises(KeyError, match="no input 'DI99'; it has DI00, .*DI17"):
        line["saw"].inputs["DI99"]
    with pytest.raises(KeyError, match="no output 'DO09'; it has DB00, DO01"):
        line["saw"].outputs["DO09"]
    with pytest.raises(KeyError, match="AI1, AI2, frequency, potentiometer"):
        line["saw"].analog["AI9"]
    with pytest.raises(KeyError, match="no parameter 'P9999'"):
        line["saw"].parameters["P9999"]
    with pytest.raises(KeyError, match="no bus 'can7'; the plant has sbus"):
        line.buses["can7"]
    with pytest.raises(KeyError, match="PO1, PO2"):
        line["saw"].words["PO9"]


def test_a_wrong_name_says_which_is_nearest(line):
    with pytest.raises(KeyError, match="did you mean 'speed'.*lCount.*states .*position"):
        line.record(["saw.sped"], "1ms")
    with pytest.raises(KeyError, match="did you mean 'lCount'"):
        line["saw"]["lCuont"]
    with pytest.raises(KeyError, match="has no variable ''"):
        line["saw"][""]
    with pytest.raises(KeyError) as caught:
        line["mill"]
    assert type(caught.value).__name__ == "KeyError"


def test_what_has_names_is_a_mapping(line):
    saw = line["saw"]
    for named in (line, line.buses, saw, saw.parameters, saw.inputs, saw.outputs, saw.analog, saw.words):
        assert list(dict(named)) == list(named) == list(named.keys())
        assert named.get("no such name") is None
        assert named._ipython_key_completions_() == list(named)
    assert dict(saw.inputs)["DI00"] is True or dict(saw.inputs)["DI00"] is False


# Every text that the package hands to the library: with a zero in it the library would see another one.
def test_no_text_may_have_a_zero_in_it(line):
    saw, wrong = line["saw"], "P130\0x"
    for use in (
        lambda: line.run("1s\0x"), lambda: line.record(["saw.lCount"], "1s\0x"), lambda: line.reader("saw.lCount\0x"),
        lambda: line.replay(["saw.lCount"], "1ms\0x"), lambda: saw["lCount\0x"], lambda: saw.parameters[wrong],
        lambda: saw.parameters.__setitem__("P130", "2 s\0x"), lambda: saw.analog.__setitem__("AI1", "5 V\0x"),
        lambda: saw.inputs["DI01\0x"], lambda: line.plant_fault("sbus\0x", "cut"), lambda: ipos.Plant(LINE + "\0x"),
        lambda: ipos.Plant(text="\0"), lambda: ipos.Plant(LINE, folder="x\0"), lambda: ipos.Plant(LINE, defines=["A\0"]),
        lambda: ipos.Plant(LINE, include_dirs=["x\0"]), lambda: line.run(until=lambda: False, limit="1s\0x"),
    ):  # fmt: skip
        with pytest.raises(ValueError):
            use()
    assert line.time == 0


def test_no_message_names_a_function_of_c(line):
    for number in range(64):
        assert "ipos_plant" not in str(ipos._library.error_of(number, "")), number


def test_wrong_types_and_values(line):
    saw = line["saw"]
    for wrong in ("5", 5.0, None, []):
        with pytest.raises(TypeError):
            saw["lCount"] = wrong
    for wrong in (2**31, -(2**31) - 1, 2**63, 2**80, -(2**80)):
        with pytest.raises(ValueError):
            saw["lCount"] = wrong
    for wrong in (5, None, b"lCount", ("lCount",)):
        with pytest.raises(TypeError):
            saw[wrong]
    with pytest.raises(ValueError):
        saw["lCo\0unt"]
    with pytest.raises(ValueError):
        saw.inputs["DI01"] = 2
    with pytest.raises(TypeError):
        saw.inputs["DI01"] = "on"
    with pytest.raises(TypeError, match="can only be read"):
        saw.outputs["DO01"] = True
    with pytest.raises(TypeError):
        saw.parameters["P130"] = 2.5
    with pytest.raises(ValueError, match="P130"):
        saw.parameters["P130"] = "2.5 rpm"
    with pytest.raises(ValueError, match='"5 V"'):
        saw.analog["AI1"] = "11 V"
    with pytest.raises(TypeError):
        saw.analog["AI1"] = True
    with pytest.raises(TypeError, match="can only be read"):
        saw.words["PI1"] = 1
    with pytest.raises(ValueError):
        saw.words["PO1"] = 70000
    assert saw["lCount"] == 0


def test_parameters_have_texts_and_the_unit_refuses_in_words(line):
    saw = line["saw"]
    saw.parameters["P130"] = 3000
    assert saw.parameters["P130"].text == "3.000 s"
    assert saw.parameters[8470] == saw.parameters["P130"]
    with pytest.raises(ipos.RefusedError, match="P130"):
        saw.parameters["P130"] = 99_000_000
    assert saw.parameters["P130"] == 3000
    assert "P130" in saw.parameters and "P9999" not in saw.parameters
    assert "3.000 s" in repr(saw.parameters["P130"])


def test_wholes_are_read_and_written(line):
    saw = line["saw"]
    line.run("5ms")
    assert saw["TrCycl"]["ObjectNo"] == 1024 and saw["TrCycl"]["CycleTime"] == 100
    saw["lSteps"] = [7, 8, 9]
    assert saw["lSteps"] == [7, 8, 9] and saw["lSteps[1]"] == 8
    saw["lSteps"] = {"[0]": 1}
    assert saw["lSteps"] == [1, 8, 9]
    with pytest.raises(TypeError):
        saw["lSteps"] = 5
    with pytest.raises(TypeError):
        saw["lSteps"] = [1, 2]
    with pytest.raises(KeyError):
        saw["TrCycl"] = {"Nothing": 1}
    assert "lCount" in saw and "lNone" not in saw and "lSteps[2]" in list(saw)


def test_force_holds_and_release_lets_go(line):
    saw = line["saw"]
    saw.force("lCount", 1000)
    line.run("100ms")
    # The program adds 1 at most between two looks of the holder.
    assert 1000 <= saw["lCount"] <= 1001
    saw.release("lCount")
    line.run("100ms")
    assert saw["lCount"] >= 1009
    saw.inputs.force("DI03", False)
    assert saw.inputs["DI03"] is False
    saw.inputs["DI03"] = True
    line.run("10ms")
    assert saw.inputs["DI03"] is False and not saw.enabled and "ENABLE" in saw.why
    saw.inputs.release("DI03")
    line.run("10ms")
    assert saw.inputs["DI03"] is True and saw.enabled


def test_analog_setpoint_turns_the_shaft(line):
    saw = line["saw"]
    saw.analog["AI1"] = "5 V"
    line.run("5s")
    # 10 V are the maximum speed P302, 1500 rpm: 5 V are half of it.
    assert saw.speed == pytest.approx(750, abs=1)
    saw.analog["AI1"] = -2.5
    line.run("5s")
    assert saw.speed == pytest.approx(-375, abs=1)
    assert saw.setpoint == pytest.approx(-375, abs=1) and saw.position != 0


def test_process_words_run_the_belt(line):
    belt = line["belt"]
    belt.words.force("PO1", 6)
    belt.words["PO2"] = 3000  # P871: speed, 0.2 rpm a digit
    line.run("5s")
    assert belt.enabled and belt.words["PO1"] == 6
    assert belt.words["PI1"] & 1
    belt.words.release("PO1")
    belt.words["PO1"] = 0
    line.run("100ms")
    assert not belt.enabled


def test_mains(line):
    belt = line["belt"]
    assert belt.mains
    belt.mains = False
    line.run("4s")
    assert not belt.mains and belt.powered and not belt.ready
    assert "no mains" in belt.why
    assert belt.parameters["P008"] == 0
    belt.mains = True
    line.run("1s")
    assert belt.mains and belt.ready


def test_power_program_and_faults(line):
    saw = line["saw"]
    line.run("50ms")
    saw.power_off()
    assert not saw.powered and saw.why == "the power is off"
    line.run("10ms")
    saw.powered = True
    line.run("50ms")
    assert saw.powered and saw["lCount"] > 0
    saw.stop_program()
    assert not saw.running
    saw.start_program()
    assert saw.running
    with pytest.raises(ipos.RefusedError, match="runs already"):
        saw.start_program()
    saw.restart_program()
    saw.raise_fault(26)
    line.run("5ms")
    assert saw.fault == 26 and "fault" in saw.why
    assert any(entry.weight == "fault" and entry.station == "saw" for entry in line.journal)
    assert "saw" in str(line.journal[-1])
    saw.reset_fault()
    line.run("5ms")
    assert saw.fault == 0
    with pytest.raises(ValueError):
        saw.raise_fault(256)
    assert saw.program_fault == 0 and saw.ready


def test_a_restart_is_a_new_plant(line):
    def run(plant, count):
        plant["saw"]["lCount"] = count
        plant.plant_fault("sbus", "drop", rate=100, seed=count)
        plant.run("300ms")
        return plant.time_us, plant["saw"]["lCount"], plant["saw"].speed, plant.trace_hash

    first = run(line, 500)
    line["saw"].raise_fault(26)
    line.run("50ms")
    line.restart()
    assert line.time_us == 0
    second = run(line, 7)
    line.restart()
    assert run(line, 500) == first
    with ipos.Plant(LINE) as other:
        assert run(other, 7) == second


def test_snapshots_go_back_and_elsewhere(line):
    saw = line["saw"]
    line.run("100ms")
    saw["lCount"] = 500
    saw.analog["AI1"] = "5 V"
    line.buses["sbus"].send(0x123, b"\1")
    line.run("50ms")
    snapshot = line.snapshot()
    here = (line.time_us, saw["lCount"], saw.speed, line.trace_hash)
    line.run("1s")
    there = (line.time_us, saw["lCount"], saw.speed, line.trace_hash)
    line.restore(snapshot)
    assert (line.time_us, saw["lCount"], saw.speed, line.trace_hash) == here
    line.run("1s")
    assert (line.time_us, saw["lCount"], saw.speed, line.trace_hash) == there
    with ipos.Plant(LINE) as other:
        other.restore(snapshot)
        assert (other.time_us, other["saw"]["lCount"], other["saw"].speed, other.trace_hash) == here
    with ipos.Plant(LINE, seed=1) as different:
        with pytest.raises(ipos.PlantError, match="another file"):
            different.restore(snapshot)
        assert different.time == 0
    for damage in (b"", b"nothing", snapshot[:-1], snapshot[:-5] + bytes([snapshot[-5] ^ 1]) + snapshot[-4:]):
        with pytest.raises(ipos.PlantError):
            line.restore(damage)
    with pytest.raises(TypeError):
        line.restore("text")
    assert line.trace_hash == there[3]


def test_without_record_there_is_no_snapshot():
    with ipos.Plant(LINE, record=False) as plant:
        plant.run("10ms")
        for use in (plant.snapshot, lambda: plant.trace_hash, lambda: plant.restore(b"x")):
            with pytest.raises(ipos.PlantError, match="without record"):
                use()


def test_mistakes_have_places():
    with pytest.raises(ipos.PlantError) as caught:
        ipos.Plant(text='[[station]]\nname = "a"\nunit = "mdxx"\n')
    mistake = caught.value.errors[0]
    assert (mistake.line, mistake.column) == (3, 8) and "mdxx" in mistake.text
    assert "3:8" in str(caught.value)
    with pytest.raises(ipos.PlantError) as caught:
        ipos.Plant("nowhere.toml")
    assert caught.value.errors[0].file == "nowhere.toml" and caught.value.errors[0].line == 0
    for wrong in (5, b"line.toml\0", ["line.toml"]):
        with pytest.raises((TypeError, ValueError)):
            ipos.Plant(wrong)
    with pytest.raises(TypeError):
        ipos.Plant()


# A plant text, what of it is wrong, and programs beside it. `ipos run` is the measure: the same places.
@pytest.mark.parametrize(
    "keys, places",
    [
        ('unit = "mdxb"\n[station.parameters]\nP130 = "x"\nP131 = -1\nP9999 = 3\n', [(5, 8), (6, 8), (7, 9)]),
        ('unit = "mdxb"\nunti = 1\n[station.parameters]\nP130 = "x"\nP131 = -1\n', [(4, 1), (6, 8), (7, 8)]),
        ('unit = "mdxb"\nprogram = "none.IPC"\n[station.parameters]\nP131 = -1\n', [(4, 11), (6, 8)]),
        ('unit = "mdxb"\nprogram = "P.IPC"\nunti = 1\n[station.parameters]\nP131 = -1\n', [(5, 1), (7, 8), (2, 10)]),
        ('unit = "mdxx"\n[[station]]\nname = "b"\nunit = "mc07"\n[station.parameters]\nP130 = -1\n', [(3, 8), (8, 8)]),
    ],
)
def test_all_mistakes_are_told_as_run_tells_them(tmp_path, keys, places):
    (tmp_path / "P.IPC").write_text("#include <constb.h>\nmain() { lNone = 1; }\n")
    (tmp_path / "l.toml").write_text('[[station]]\nname = "a"\n' + keys)
    with pytest.raises(ipos.PlantError) as caught:
        ipos.Plant(tmp_path / "l.toml")
    found = [(error.line, error.column) for error in caught.value.errors]
    assert [line for line, _ in found] == [line for line, _ in places], caught.value
    if "IPOS" not in os.environ:
        return
    told = subprocess.run([os.environ["IPOS"], "run", "l.toml"], cwd=tmp_path, capture_output=True, text=True).stderr
    for error in caught.value.errors:
        assert f"{os.path.basename(error.file)}:{error.line}:{error.column}: error" in told, told
    assert told.count(": error") == len(found), told


def test_a_mistake_of_a_program_has_its_file(tmp_path):
    (tmp_path / "P.IPC").write_text("#include <constb.h>\nmain()\n{\n  lNone = 1;\n}\n")
    text = '[[station]]\nname = "a"\nunit = "mdxb"\nprogram = "P.IPC"\n'
    with pytest.raises(ipos.PlantError) as caught:
        ipos.Plant(text=text, folder=tmp_path)
    mistake = caught.value.errors[0]
    assert mistake.file.endswith("P.IPC") and mistake.line == 4 and "lNone" in mistake.text
    (tmp_path / "P.IPC").write_text("#include <constb.h>\nlong lNone;\nmain()\n{\n  lNone = FROM_OUTSIDE;\n}\n")
    with ipos.Plant(tmp_path / "P.IPC", defines={"FROM_OUTSIDE": 7}) as plant:
        plant.run("10ms")
        assert plant["P"]["lNone"] == 7


def test_a_closed_plant_raises_and_never_crashes(line):
    saw, bus = line["saw"], line.buses["sbus"]
    reader = line.reader("saw.lCount")
    line.close()
    line.close()
    uses = (
        lambda: line.run("1s"), lambda: line["saw"], lambda: line.time, lambda: line.journal, lambda: line.buses,
        lambda: saw["lCount"], lambda: saw.speed, lambda: saw.parameters["P130"], lambda: list(saw.inputs),
        lambda: bus.frames(), lambda: bus.send(1), lambda: bus.load, lambda: reader(), lambda: line.snapshot(),
        lambda: line.restore(b"x"), lambda: line.trace_hash, lambda: line.adopt(), lambda: saw.power_off(),
    )  # fmt: skip
    for use in uses:
        with pytest.raises(ipos.ClosedError, match="closed"):
            use()
    assert "closed" in repr(line) and "closed" in repr(saw) and "closed" in repr(bus)
    with pytest.raises(ipos.ClosedError):
        line.__enter__()


def test_a_second_thread_is_refused(line):
    raised = []

    def use():
        for action in (lambda: line.run("1ms"), lambda: line["saw"]["lCount"], lambda: line.time):
            try:
                action()
            except ipos.ThreadError as error:
                raised.append(str(error))

    other = threading.Thread(target=use)
    other.start()
    other.join()
    assert len(raised) == 3 and "another thread" in raised[0]
    line.run("1ms")

    def take_over():
        line.adopt()
        line.run("1ms")

    other = threading.Thread(target=take_over)
    other.start()
    other.join()
    with pytest.raises(ipos.ThreadError):
        line.run("1ms")
    line.adopt()
    assert line.time_us == 2000


def test_the_plant_is_used_within_a_condition(line):
    seen = []
    line.run(until=lambda: seen.append(line["saw"]["lCount"]) or len(seen) == 3, limit="1s")
    assert len(seen) == 3
    with pytest.raises(ZeroDivisionError):
        line.run(until=lambda: 1 / 0)


def test_many_signals_in_one_call(line):
    line.run("105ms")
    saw = line["saw"]
    reader = line.reader("saw.lCount", "saw.H430", "saw.speed", "belt.DI01", "saw.P130")
    assert reader() == (saw["lCount"], saw["H430"], saw.speed, 1, 2.0)
    assert reader.units == ("", "", "rpm", "", "s")
    # Any signal of the recording page, also after the plant was made anew.
    reader = line.reader("saw.torque", "saw.DI03", "saw.PO1.6", "saw.task1.line")
    before = reader()
    assert reader.units[0] == "%Mn" and 10 <= before[3] <= 35
    line.restore(line.snapshot())
    assert reader() == before
    with pytest.raises(KeyError, match="begin with saw., belt., sbus."):
        line.reader("mill.lCount")
    with pytest.raises(TypeError):
        line.reader(5)


def test_a_recording(line):
    line["saw"].analog["AI1"] = "10 V"
    recording = line.record(["saw.speed", "saw.lCount"], "600ms", every="10ms")
    assert recording.times == pytest.approx([n / 100 for n in range(61)])
    speeds = recording["saw.speed"]
    # A ramp of 2 s for 3000 rpm: 1.5 rpm a millisecond once the brake is open.
    assert speeds[60] - speeds[59] == pytest.approx(15, abs=0.1)
    with pytest.raises(KeyError):
        recording["saw.H1"]
    with pytest.raises(ValueError):
        line.record(["saw.speed"], "1s", every=0)


class Pandas:
    """In place of pandas, which need not be installed: what it is given."""

    class Index(list):
        def __init__(self, values, name):
            super().__init__(values)
            self.name = name

    class DataFrame:
        def __init__(self, data, index=None, columns=None):
            self.data, self.index, self.columns, self.attrs = data, index, columns, {}


def test_recordings_and_frames_for_pandas(line, monkeypatch):
    saw = line["saw"]
    recording = line.record(["saw.speed", "saw.lCount"], "50ms", every="10ms")
    bus = next(iter(line.buses.values()))
    frames = bus.frames()
    line.run("50ms")
    monkeypatch.setitem(sys.modules, "pandas", None)  # as if it were not installed
    for use, words in ((recording.to_pandas, "recording.times"), (bus.to_pandas, "bus.frames()")):
        with pytest.raises(ImportError, match="needs pandas") as caught:
            use()
        assert words in str(caught.value)
    monkeypatch.setitem(sys.modules, "pandas", Pandas)
    table = recording.to_pandas()
    assert list(table.data) == ["saw.speed", "saw.lCount"] and table.data["saw.lCount"] == recording["saw.lCount"]
    assert list(table.index) == recording.times and table.index.name == "time [s]"
    assert table.attrs["units"]["saw.speed"] == "rpm"
    assert saw["lCount"] is not None and frames is not None
    table = bus.to_pandas()
    assert table.columns[:3] == ["time", "id", "data"] and len(table.data) == len(bus.last) - len(frames)
    assert [row[1] for row in table.data] == [frame.id for frame in list(bus.last)[len(frames) :]]


def test_a_replay_shows_what_nobody_has_recorded(line, tmp_path):
    saw = line["saw"]
    line.run("50ms")
    saw.analog["AI1"] = "10 V"
    line.run("200ms")
    here = (line.time_us, saw["lCount"], line.trace_hash)
    recording = line.replay(["saw.lCount", "saw.AI1"], every="10ms")
    assert recording.times == pytest.approx([n / 100 for n in range(26)])
    assert recording["saw.lCount"][-1] == saw["lCount"] and recording["saw.lCount"][0] == 0
    assert recording["saw.AI1"] == [0.0] * 6 + [10.0] * 20
    assert (line.time_us, saw["lCount"], line.trace_hash) == here
    recording.write_csv(tmp_path / "r.csv")
    assert (tmp_path / "r.csv").read_text().splitlines()[0] == "time [s],saw.lCount,saw.AI1 [V]"
    with pytest.raises(KeyError):
        line.replay(["saw.lNone"])


def test_fault_of_a_line_planted_at_run_time(line):
    line.run("1s")
    bus = line.buses["sbus"]
    bus.frames()
    line.plant_fault("sbus", "cut", station="saw", **{"from": "0ms", "until": "500ms"})
    line.run("450ms")
    assert [frame for frame in bus.frames() if frame.sender == "saw"] == []
    line.run("1s")
    assert [frame for frame in bus.frames() if frame.sender == "saw"]
    with pytest.raises(ValueError, match="line 2.*can7"):
        line.plant_fault("can7", "cut", station="saw")
    with pytest.raises(ValueError, match="known are"):
        line.plant_fault("sbus", "rain")
    with pytest.raises(TypeError):
        line.plant_fault("sbus", "drop", rate=0.5)


def test_plants_are_freed_and_cannot_be_pickled(line):
    import pickle

    plant = ipos.Plant(LINE)
    gone = weakref.ref(plant)
    del plant
    gc.collect()
    assert gone() is None
    with pytest.raises(TypeError):
        pickle.dumps(line)


def test_memory_files_are_written_only_when_asked(tmp_path):
    text = '[[station]]\nname = "a"\nunit = "mdxb"\nnvram = "a.nv"\n'
    with ipos.Plant(text=text, folder=tmp_path) as plant:
        plant.run("10ms")
    assert not (tmp_path / "a.nv").exists()
    with ipos.Plant(text=text, folder=tmp_path, write_memory=True) as plant:
        plant.run("10ms")
        with pytest.raises(ipos.PlantError):
            plant.snapshot()
    assert (tmp_path / "a.nv").exists()


PROFIBUS = """
[[bus]]
name = "dp"
kind = "profibus"
baud = 1500000
[[station]]
name = "inv"
unit = "mc31"
option = "ffp31"
profibus = "dp"
profibus_address = 8
"""


def test_a_profibus_line():
    """EN 50170: 10 DA SA FC FCS 16 asks for the FDL status; the slave answers with FC 00. The first frame gives it its rate."""
    with ipos.Plant(text=PROFIBUS) as plant:
        bus = plant.buses["dp"]
        assert (bus.kind, bus.baud) == ("profibus", 1500000)
        status = bytes([0x10, 8, 2, 0x49, 0x53, 0x16])
        for _ in range(2):
            bus.send(status)
            plant.run("1ms")
        frames = bus.frames()
        assert [frame.data for frame in frames] == [status, status, bytes([0x10, 2, 8, 0, 10, 0x16])]
        assert all(frame.valid for frame in frames) and frames[-1].text.startswith("8 -> 2")
        assert bus.count == 3 and round(bus.load, 1) == round(100 * 3 * 66 / 3000, 1)
        bus.send(bytes([0x10, 8, 2, 0x49, 0x54, 0x16]))
        plant.run("1ms")
        (wrong,) = bus.frames()
        assert not wrong.valid and "frame check" in wrong.text
        with pytest.raises(TypeError):
            bus.send(8, b"1")


def test_fms_of_a_station():
    """MOVITRAC 31 PROFIBUS, 4.2: P120 is 25, so object 1025, four octets BCD of 0.01 s; too large a value is class 8, code 0, 15h."""
    with ipos.Plant(text=PROFIBUS) as plant:
        station = plant.buses["dp"].fms(8)
        station.write(1025, bytes.fromhex("00000950"))
        assert station.read(1025) == bytes.fromhex("00000950")
        assert plant["inv"].parameters["P120"].text == "9.50 s"
        assert station.describe(991) == "991: object code 7, data type 10, 2 octets, read all"
        assert station.identify().startswith("SEW-Eurodrive GmbH & Co, MOVITRAC, 821")
        assert station.status() == bytes(2)
        with pytest.raises(ipos.FmsError) as refused:
            station.write(1025, bytes.fromhex("99999999"))
        assert refused.value.code == 0x08000015
        saved = plant.snapshot()
        station.write(1025, bytes.fromhex("00000120"))
        plant.restore(saved)
        assert station.read(1025) == bytes.fromhex("00000950")
        with pytest.raises(ipos.FmsError):
            plant.buses["dp"].fms(9, limit="1s").read(1025)
        with pytest.raises(ValueError):
            plant.buses["dp"].fms(8, connection=9).read(1025)


def test_the_shaft_takes_a_load(line):
    saw = line["saw"]
    assert list(saw.shaft) == ["shaft_speed", "load_torque"]
    assert saw.shaft["load_torque"] == 0
    saw.shaft["load_torque"] = 1.25
    assert saw.shaft["load_torque"] == 1.25
    saw.shaft["load_torque"] = "-0.5 Nm"
    assert saw.shaft["load_torque"] == -0.5
    saw.shaft.force("load_torque", 2)
    line.run("2ms")
    assert saw.shaft["load_torque"] == 2.0
    saw.shaft.release("load_torque")
    with pytest.raises(TypeError):
        saw.shaft["load_torque"] = True
    with pytest.raises(TypeError):
        saw.shaft["shaft_speed"] = None
    with pytest.raises(TypeError, match="can only be read"):
        saw.shaft["shaft_speed"] = 100.0
