"""A station of a plant: its variables, parameters, terminals, process words, motion and power."""

from __future__ import annotations

import operator
from ctypes import byref, c_bool, c_char_p, c_int64, c_uint32
from typing import TYPE_CHECKING, Iterator, Mapping

from . import _library as lib
from ._signals import Scale, SignalOwner

if TYPE_CHECKING:
    from .plant import Plant

_PROGRAM_ORDERS = {"start": 0, "stop": 1, "restart": 2}


class ParameterValue(int):
    """A parameter as the parameter channel codes it, with `.text` as people read it: "2.500 s"."""

    name: str
    text: str

    def __repr__(self) -> str:
        return f"<{self.name} = {self.text} ({int(self)})>"


class AnalogValue(float):
    """What hangs on an analog input, in `.unit`: 5.0 with "V"."""

    name: str
    unit: str

    @property
    def text(self) -> str:
        return f"{float(self):g} {self.unit}"

    def __repr__(self) -> str:
        return f"<{self.name} = {self.text}>"


def _whole_number(value: object) -> int:
    try:
        number = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"this takes a whole number, not {type(value).__name__}") from None
    if not -(2**63) <= number < 2**63:
        raise ValueError(f"{number} is out of range")
    return number


def _level(value: object) -> int:
    number = _whole_number(value)
    if number not in (0, 1):
        raise ValueError(f"a level is True or False, not {number}")
    return number


class _Signals(lib.Named):
    """Signals of one kind of a station, by name."""

    kind = lib.ANY
    what = "signals"

    def __init__(self, station: "Station") -> None:
        self._station = station

    def __getitem__(self, name: str) -> object:
        return self._read(self._station._find(self.kind, name), name)

    def __setitem__(self, name: str, value: object) -> None:
        self._write("write", name, value)

    def force(self, name: str, value: object) -> None:
        """Holds a value from now on, whatever the plant does, until release()."""
        self._write("force", name, value)

    def release(self, name: str) -> None:
        """Ends force()."""
        self._station._plant._call("release", self._station._find(self.kind, name))

    def __iter__(self) -> Iterator[str]:
        return iter(self._station._names(self.kind))

    def __len__(self) -> int:
        return len(self._station._names(self.kind))

    def __contains__(self, name: object) -> bool:
        try:
            self._station._find(self.kind, name)
        except (KeyError, TypeError):
            return False
        return True

    def __repr__(self) -> str:
        return f"<{self.what} of {self._station.name}: {', '.join(self)}>"

    def _read(self, signal: int, name: str) -> object:
        return self._station._read(signal)

    def _write(self, how: str, name: str, value: object) -> None:
        self._station._write(how, self._station._find(self.kind, name), _whole_number(value))


class Parameters(_Signals):
    """station.parameters["P130"] = "2.5 s"; a number is the coding of the parameter channel."""

    kind = lib.PARAMETER
    what = "parameters"

    def __getitem__(self, name: str | int) -> ParameterValue:
        return super().__getitem__(self._name(name))  # type: ignore[return-value]

    def __setitem__(self, name: str | int, value: object) -> None:
        super().__setitem__(self._name(name), value)

    @staticmethod
    def _name(name: str | int) -> str:
        return str(name) if isinstance(name, int) and not isinstance(name, bool) else name  # type: ignore[return-value]

    def _read(self, signal: int, name: str) -> ParameterValue:
        value = ParameterValue(self._station._read(signal))
        value.name, value.text = name, self._station._text(signal)
        return value

    def _write(self, how: str, name: str, value: object) -> None:
        if isinstance(value, str):
            return self._station._write_text(how, self._station._find(self.kind, name), value)
        if isinstance(value, float):
            raise TypeError(f"{name} takes a text with unit such as '2.5 s', or the number of the parameter channel")
        super()._write(how, name, value)


class Inputs(_Signals):
    """station.inputs["DI01"] = True"""

    kind = lib.INPUT
    what = "inputs"

    def _read(self, signal: int, name: str) -> bool:
        return bool(self._station._read(signal))

    def _write(self, how: str, name: str, value: object) -> None:
        self._station._write(how, self._station._find(self.kind, name), _level(value))


class Outputs(_Signals):
    """station.outputs["DO01"], to be read."""

    kind = lib.OUTPUT
    what = "outputs"

    def _read(self, signal: int, name: str) -> bool:
        return bool(self._station._read(signal))


class Analog(_Signals):
    """station.analog["AI1"] = "5 V" (or "12 mA", "5 kHz", "50 %"); a number counts in the unit it has."""

    kind = lib.ANALOG
    what = "analog inputs"

    def _read(self, signal: int, name: str) -> AnalogValue:
        scale = self._station._scale(signal)
        value = AnalogValue(self._station._read(signal) * scale.factor)
        value.name, value.unit = name, scale.unit
        return value

    def _write(self, how: str, name: str, value: object) -> None:
        signal = self._station._find(self.kind, name)
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            value = f"{float(value):.6f} {self._station._scale(signal).unit}"
        if not isinstance(value, str):
            raise TypeError(f"{name} takes a text with unit such as '5 V', or a number, not {type(value).__name__}")
        self._station._write_text(how, signal, value)


class Words(_Signals):
    """station.words["PO1"] = 6: process data as over the bus of P100 and P101; PI1..PI3 can be read."""

    kind = lib.WORD
    what = "process words"


class Shaft(_Signals):
    """station.shaft["load_torque"] = "3.5 Nm"; a number counts in the unit it has, Nm, or rpm of "shaft_speed", which can
    be written where [station.load] says driven = true."""

    kind = lib.SHAFT
    what = "values of the shaft"

    def _read(self, signal: int, name: str) -> float:
        return self._station._read(signal) * self._station._scale(signal).factor

    def _write(self, how: str, name: str, value: object) -> None:
        signal = self._station._find(self.kind, name)
        if isinstance(value, str):
            return self._station._write_text(how, signal, value)
        if not isinstance(value, (int, float)) or isinstance(value, bool):
            raise TypeError(f"{name} takes a text with unit such as '3.5 Nm', or a number, not {type(value).__name__}")
        self._station._write(how, signal, _whole_number(round(value / self._station._scale(signal).factor)))


class Station(lib.Named, SignalOwner):
    """plant["saw"]. Variables by name: saw["lCount"], saw["TrCycl.Result"], saw["H430"]; saw["lCount"] = 5."""

    def __init__(self, plant: "Plant", number: int, info: lib.StationInfo) -> None:
        SignalOwner.__init__(self, plant, number)
        self._number = number
        self.name = lib.text(info.name)
        self.unit = lib.text(info.unit)
        self.title = lib.text(info.title)
        self.program = lib.text(info.program)
        self._wholes: dict[str, list[str] | None] = {}
        self.parameters = Parameters(self)
        self.inputs = Inputs(self)
        self.outputs = Outputs(self)
        self.analog = Analog(self)
        self.words = Words(self)
        self.shaft = Shaft(self)

    def __repr__(self) -> str:
        if self._plant._closed:
            return f"<Station {self.name} of a closed plant>"
        state = f"F{self.fault:02}" if self.fault else ("enabled" if self.enabled else "not enabled")
        return f"<Station {self.name} ({self.title}{', ' + self.program if self.program else ''}): {state}>"

    # --- variables

    def __getitem__(self, name: str) -> int | list | dict:
        whole = self._whole(name)
        if whole is None:
            return self._read(self._find(lib.VARIABLE, name))
        values = {each[len(name) :]: self._read(self._find(lib.VARIABLE, each)) for each in whole}
        if all(key == f"[{n}]" for n, key in enumerate(values)):
            return list(values.values())
        return {key.lstrip("."): value for key, value in values.items()}

    def __setitem__(self, name: str, value: object) -> None:
        for each, number in self._parts(name, value):
            self._write("write", self._find(lib.VARIABLE, each), _whole_number(number))

    def force(self, name: str, value: object) -> None:
        """Holds a variable, or every member of a whole, until release()."""
        for each, number in self._parts(name, value):
            self._write("force", self._find(lib.VARIABLE, each), _whole_number(number))

    def release(self, name: str) -> None:
        """Ends force()."""
        for each in self._whole(name) or [name]:
            self._plant._call("release", self._find(lib.VARIABLE, each))

    def _parts(self, name: str, value: object) -> list[tuple[str, object]]:
        whole = self._whole(name)
        if whole is None:
            return [(name, value)]
        if isinstance(value, Mapping):
            wrong = [key for key in value if f"{name}.{key}" not in whole and f"{name}{key}" not in whole]
            if wrong:
                raise lib.unknown(f"'{name}' has no {wrong[0]!r}; it has {', '.join(whole)}")
            return [(f"{name}.{key}" if f"{name}.{key}" in whole else f"{name}{key}", each) for key, each in value.items()]
        if isinstance(value, (list, tuple)) and len(value) == len(whole):
            return list(zip(whole, value))
        raise TypeError(f"'{name}' is a whole of {len(whole)} variables: write a dict, or a list of {len(whole)} numbers")

    def _whole(self, name: str) -> list[str] | None:
        """The members of a structure or array; nothing for one variable."""
        if name not in self._wholes:
            if not isinstance(name, str):
                raise TypeError(f"a variable is named by a text, not {type(name).__name__}")
            names = self._names(lib.VARIABLE, name)
            self._wholes[name] = names if len(names) > 1 else None
        return self._wholes[name]

    @property
    def variables(self) -> list[str]:
        """Names of the program's variables, member by member."""
        return self._names(lib.VARIABLE)

    def __iter__(self) -> Iterator[str]:
        return iter(self.variables)

    def __len__(self) -> int:
        return len(self.variables)

    def __contains__(self, name: object) -> bool:
        try:
            self._find(lib.VARIABLE, name)
        except (KeyError, TypeError):
            return False
        return True

    # --- motion and states

    @property
    def speed(self) -> float:
        """Of the shaft, rpm."""
        return self._state("speed") / 1000

    @property
    def setpoint(self) -> float:
        """The speed the ramp orders, rpm."""
        return self._state("setpoint") / 1000

    @property
    def position(self) -> int:
        """Increments the shaft has turned."""
        return self._state("position")

    @property
    def fault(self) -> int:
        """Number of the error or warning; 0 is none."""
        return self._state("fault")

    @property
    def status_word(self) -> int:
        """Status word 1."""
        return self._state("status")

    @property
    def enabled(self) -> bool:
        return bool(self._state("enabled"))

    @property
    def ready(self) -> bool:
        return bool(self._state("ready"))

    @property
    def why(self) -> str:
        """Why the drive does not run, or not as its setpoint says; "enabled" when it does."""
        return self._plant._text("why", self._number)

    @property
    def ideal_motor(self) -> bool:
        """The motor is the ideal one of 1.5 kW, as the plant file has no [station.motor]: currents and heat are those of that motor, and
        without control = "real" its speed does not sag under load. False of a gateway, which has no motor."""
        ideal = c_bool()
        self._plant._call("ideal_motor", self._number, byref(ideal))
        return ideal.value

    @property
    def running(self) -> bool:
        """A task of the program runs or waits."""
        return bool(self._state("running"))

    @property
    def program_fault(self) -> int:
        """Number of the fault that ended the program; 0 is none."""
        return self._state("program_fault")

    @property
    def powered(self) -> bool:
        return bool(self._state("powered"))

    @powered.setter
    def powered(self, on: bool) -> None:
        self._plant._call("power", self._number, bool(_level(on)))

    @property
    def mains(self) -> bool:
        """The mains of the unit; without them it runs on its 24 V supply, and its motor not at all."""
        return bool(self._state("mains"))

    @mains.setter
    def mains(self, on: bool) -> None:
        self._write("write", self._find(lib.STATE, "mains"), int(_level(on)))

    def power_off(self) -> None:
        self.powered = False

    def power_on(self) -> None:
        self.powered = True

    def start_program(self) -> None:
        """Refused while it runs."""
        self._plant._call("program", self._number, _PROGRAM_ORDERS["start"])

    def stop_program(self) -> None:
        self._plant._call("program", self._number, _PROGRAM_ORDERS["stop"])

    def restart_program(self) -> None:
        self._plant._call("program", self._number, _PROGRAM_ORDERS["restart"])

    def raise_fault(self, number: int) -> None:
        """A drive fault, 1..255, with the response its parameter chooses."""
        number = _whole_number(number)
        if not 1 <= number <= 255:
            raise ValueError("a drive fault is 1..255")
        self._plant._call("drive_fault", self._number, number)

    def reset_fault(self) -> None:
        self._plant._call("reset_fault", self._number)

    # --- the library

    def _state(self, name: str) -> int:
        return self._read(self._find(lib.STATE, name))

    def _names(self, kind: int, part: str | None = None) -> list[str]:
        names: list[str] = []
        name = c_char_p()
        whole = None if part is None else lib.encoded(part)
        with self._plant._gate as handle:
            while True:
                status = lib.function("name_at")(handle, self._number, kind, whole, len(names), byref(name))
                if status == lib.NOTHING:
                    return names
                if status != lib.OK:
                    raise self._plant._error(status)
                names.append(lib.text(name.value))

    def _text(self, signal: int) -> str:
        return self._plant._text("read_text", signal)

    def _write(self, how: str, signal: int, value: int) -> None:
        self._plant._call(how, signal, value)

    def _write_text(self, how: str, signal: int, text: str) -> None:
        self._plant._call(how + "_text", signal, lib.encoded(text))
