"""MOVILINK in Python, with simulated drives that answer on a CAN line and on a serial one."""

import termios

import pytest

can = pytest.importorskip("can")

import ipos
from conftest import LINE
from ipos import movilink

SERIAL = """
[[bus]]
name = "line"
kind = "rs485"
baud = 9600
[[station]]
name = "a"
unit = "mdxb"
rs485 = "line"
[station.parameters]
P810 = 7
"""


@pytest.fixture
def sbus():
    with can.Bus(interface="ipos", channel=LINE + "#sbus") as bus:
        yield movilink.Sbus(bus)


class PortOfPlant:
    """What pyserial is to a real line: bytes out and in, on a line of a plant."""

    def __init__(self, plant):
        self.plant, self.bus, self.heard = plant, plant.buses["line"], b""

    def write(self, data):
        self.bus.send(bytes(data))

    def read(self, count):
        for _ in range(100):
            if len(self.heard) >= count:
                break
            self.plant.run("1ms")
            for telegram in self.bus.frames():
                self.heard += telegram.data
        data, self.heard = self.heard[:count], self.heard[count:]
        return data

    def reset_input_buffer(self):
        self.heard = b""

    def sleep(self, seconds):
        self.plant.run(seconds)


def test_parameters_over_sbus(sbus):
    drive = movilink.Drive(sbus, 1)
    assert drive.unit == "mdxb"
    assert drive["P130"] == 2000 and drive["P130"].text == "2.000 s"
    drive["P130"] = "2.5 s"
    assert drive["P130"] == 2500
    drive["P130"] = 3000
    assert sbus.bus.plant["saw"].parameters["P130"].text == "3.000 s"
    drive["H427"] = -5
    assert drive["H427"] == -5 and sbus.bus.plant["saw"]["lUnused"] == -5
    assert drive.status_word & 1 and drive.fault == 0
    assert next(drive.watch("P130", "H427")) == (3000, -5)


def test_refusals_are_exceptions_with_the_code(sbus):
    drive = movilink.Drive(sbus, 1)
    with pytest.raises(movilink.DriveRefusedError, match="too large") as caught:
        drive["P130"] = 99_000_000
    assert caught.value.code == 0x08000015
    with pytest.raises(ipos.RefusedError, match="invalid parameter index"):
        drive.execute(movilink.READ, 1)
    with pytest.raises(movilink.NoAnswerError):
        movilink.Drive(sbus, 33)
    with pytest.raises(ValueError):
        movilink.Drive(sbus, 64)
    with pytest.raises(KeyError):
        drive["P9999"]
    with pytest.raises(ValueError, match="s"):
        drive["P130"] = "fast"
    with pytest.raises(TypeError):
        drive["P130"] = 2.5


def test_scan_finds_both(sbus):
    drives = movilink.scan(sbus, range(8))
    assert [(drive.address, drive.unit) for drive in drives] == [(1, "mdxb"), (2, "mdxb")]


def test_each_unit_is_recognised_by_the_signs_of_the_library(tmp_path):
    known = {unit for unit, _ in movilink._signs()}
    assert {"md60a", "compact", "mc07", "mdxb", "mc07b"} <= known <= set(movilink._unit_names())
    for name in known:
        plant = tmp_path / f"{name}.toml"
        plant.write_text(
            f'[[bus]]\nname = "sbus"\nkind = "can"\nbaud = 500000\n[[station]]\nname = "u"\nunit = "{name}"\nsbus = "sbus"\n'
        )
        with can.Bus(interface="ipos", channel=f"{plant}#sbus") as bus:
            drive = movilink.Drive(movilink.Sbus(bus), 0)
            assert drive.unit == name and drive["P130"].text == "2.000 s"


def test_no_unit_type_is_told_with_those_there_are(sbus):
    with pytest.raises(ValueError, match="known are md60a, compact, mc07, mdxb, mc31, mc07b$"):
        movilink.Drive(sbus, 1, unit="nope")


def test_parameters_over_rs485():
    with ipos.Plant(text=SERIAL) as plant:
        port = PortOfPlant(plant)
        drive = movilink.Drive(movilink.Serial(port, sleep=port.sleep), 7)
        assert drive.unit == "mdxb" and drive["P130"].text == "2.000 s"
        drive["P130"] = "1.5 s"
        assert plant["a"].parameters["P130"] == 1500
        with pytest.raises(movilink.DriveRefusedError, match="too large"):
            drive["P130"] = 99_000_000
        with pytest.raises(movilink.NoAnswerError):
            movilink.Drive(movilink.Serial(port, sleep=port.sleep), 8)


class PortThatIsBusy:
    """What a pseudo-terminal does in its first millisecond: the settings are refused, once or for ever."""

    def __init__(self, timeout, refusals):
        self.refusals, self.set, self._timeout = refusals, [], timeout

    @property
    def timeout(self):
        return self._timeout

    @timeout.setter
    def timeout(self, value):
        self.set.append(value)
        if len(self.set) <= self.refusals:
            raise termios.error(22, "Invalid argument")
        self._timeout = value


def test_the_timeout_of_a_port_is_set_where_it_differs():
    slept = []
    for timeout, refusals, tries in ((0.1, 0, 0), (None, 0, 1), (None, 2, 3)):
        port = PortThatIsBusy(timeout, refusals)
        movilink.Serial(port, sleep=slept.append)
        assert (port.timeout, len(port.set)) == (0.1, tries)
    assert len(slept) == 2 and all(0.001 <= each < 0.01 for each in slept)
    with pytest.raises(termios.error):
        movilink.Serial(PortThatIsBusy(None, 99), sleep=slept.append)


DRIVE = """
[[bus]]
name = "line"
kind = "{kind}"
[[station]]
name = "a"
unit = "{unit}"
{line} = "line"
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
[station.parameters]
P100 = "{source}"
P101 = "{source}"
P870 = "CTRL. WORD 1"
P871 = "SPEED"
{address} = 1
"""


# 6: enabled; 5000 x 0.2 rpm (1053 1610 p. 40, 42). The timeouts are P812 and P883, both off as delivered; 0 and 650 s are
# off (p. 41).
def check_that_it_moves_only_where_it_is_monitored(plant, drive, delay, response, run):
    speed = lambda: abs(plant["a"].speed)  # noqa: E731
    assert len(drive.send_process_data(0, 5000, 0)) == 3
    for words in ((6, 5000, 0), (6, 5000), (6,), (0, 0, 0x0C16)):
        with pytest.raises(movilink.UnmonitoredError, match=delay):
            drive.send_process_data(*words)
    for too_long in (650_000, 649_990, 10_000, 510):  # a shaft turns on for as long
        drive.write(delay, too_long)
        with pytest.raises(movilink.UnmonitoredError, match=f"{delay}.*Switch it on"):
            drive.send_process_data(6, 5000, 0)
    drive.write(delay, 500)
    drive.write(response, "NO RESPONSE")
    with pytest.raises(movilink.UnmonitoredError, match=response):
        drive.send_process_data(6, 5000, 0)
    assert speed() == 0
    drive.write(response, "RAPID STOP/WARNG")
    for _ in range(40):
        drive.send_process_data(6, 5000, 0)
        run("0.05s")
    assert speed() > 900
    run("1.5s")  # nobody sends any more
    assert speed() == 0


def test_process_data_over_rs485():
    text = DRIVE.format(kind="rs485", unit="md60a", line="rs485", source="RS-485", address="P810")
    with ipos.Plant(text=text) as plant:
        port = PortOfPlant(plant)
        drive = movilink.Drive(movilink.Serial(port, sleep=port.sleep), 1)
        check_that_it_moves_only_where_it_is_monitored(plant, drive, "P812", "P833", plant.run)


def test_process_data_over_sbus():
    text = DRIVE.format(kind="can", unit="mdxb", line="sbus", source="SBus", address="P881")
    with ipos.Plant(text=text) as plant, can.Bus(interface="ipos", channel="line", plant=plant) as bus:
        drive = movilink.Drive(movilink.Sbus(bus), 1)
        check_that_it_moves_only_where_it_is_monitored(plant, drive, "P883", "P836", plant.run)


def test_process_data_over_the_second_sbus():
    text = DRIVE.format(kind="can", unit="mdxb", line="sbus2", source="SBus", address="P891")
    with ipos.Plant(text=text) as plant, can.Bus(interface="ipos", channel="line", plant=plant) as bus:
        drive = movilink.Drive(movilink.Sbus(bus), 1)
        drive.write("P883", 400)  # of the other one
        check_that_it_moves_only_where_it_is_monitored(plant, drive, "P893", "P837", plant.run)


def test_a_drive_with_one_address_on_both_lines_monitors_both():
    text = DRIVE.format(kind="can", unit="mdxb", line="sbus2", source="SBus", address="P891") + "P881 = 1\n"
    with ipos.Plant(text=text) as plant, can.Bus(interface="ipos", channel="line", plant=plant) as bus:
        drive = movilink.Drive(movilink.Sbus(bus), 1)
        for name, other in (("P893", "P883"), ("P883", "P893")):
            drive.write(name, 400)
            drive.write(other, 0)
            with pytest.raises(movilink.UnmonitoredError, match=other):
                drive.send_process_data(6, 5000, 0)


def test_process_data_words_are_words(sbus):
    drive = movilink.Drive(sbus, 1)
    for words in ((), (1, 2, 3, 4), (-1,), (65536,)):
        with pytest.raises(ValueError):
            drive.send_process_data(*words)
    with pytest.raises(TypeError):
        drive.send_process_data(1.5)
