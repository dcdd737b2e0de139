"""The C library behind the package: where it is found, its functions with their types, and its statuses as exceptions."""

from __future__ import annotations

import ctypes
import os
from ctypes import (
    CFUNCTYPE,
    POINTER,
    Structure,
    byref,
    c_bool,
    c_char_p,
    c_double,
    c_int32,
    c_int64,
    c_size_t,
    c_uint8,
    c_uint16,
    c_uint32,
    c_uint64,
    c_void_p,
)
from pathlib import Path
from typing import Iterator, Mapping

_WINDOWS = os.name == "nt"
_NAME = "ipos_plant.dll" if _WINDOWS else "libipos_plant.so"


def _places() -> Iterator[str]:
    """The copy in the package, one named by IPOS_PLANT_LIBRARY, the builds of a source folder, the system's."""
    named = os.environ.get("IPOS_PLANT_LIBRARY")
    if named:
        yield named
        return
    here = Path(__file__).resolve().parent
    yield str(here / _NAME)
    for build in ("windows",) if _WINDOWS else ("release", "dev"):
        yield str(here.parent.parent / "build" / build / "lib" / _NAME)
    yield _NAME if _WINDOWS else _NAME + ".0"


def _load() -> ctypes.CDLL:
    tried = []
    for place in _places():
        if os.path.dirname(place) and not os.path.exists(place):
            tried.append(place)
            continue
        try:
            return ctypes.CDLL(place)
        except OSError as error:
            tried.append(f"{place}: {error}")
    raise ImportError("no " + _NAME + "; tried\n  " + "\n  ".join(tried))


class Source(Structure):
    _fields_ = [
        ("path", c_char_p),
        ("text", c_char_p),
        ("folder", c_char_p),
        ("include_dirs", POINTER(c_char_p)),
        ("include_dir_count", c_size_t),
        ("defines", POINTER(c_char_p)),
        ("define_count", c_size_t),
        ("flags", c_uint32),
        ("commands_a_ms", c_uint32),
        ("seed", c_uint64),
    ]


class MistakeRow(Structure):
    _fields_ = [("file", c_char_p), ("text", c_char_p), ("line", c_uint32), ("column", c_uint32)]


class StationInfo(Structure):
    _fields_ = [("name", c_char_p), ("unit", c_char_p), ("title", c_char_p), ("program", c_char_p)]


class SignalInfo(Structure):
    _fields_ = [
        ("name", c_char_p),
        ("unit", c_char_p),
        ("factor", c_double),
        ("decimals", c_int32),
        ("kind", c_int32),
        ("station", c_uint32),
        ("number", c_uint32),
        ("flags", c_uint32),
    ]


class BusInfo(Structure):
    _fields_ = [("name", c_char_p), ("kind", c_int32), ("baud", c_uint32)]


class Load(Structure):
    _fields_ = [("frames", c_uint64), ("lost", c_uint64), ("percent", c_double)]


class FrameRow(Structure):
    _fields_ = [
        ("time", c_int64),
        ("id", c_uint32),
        ("flags", c_uint32),
        ("sender", c_uint32),
        ("tag", c_uint32),
        ("length", c_uint8),
        ("data", c_uint8 * 8),
    ]


class TelegramRow(Structure):
    _fields_ = [
        ("start", c_int64),
        ("end", c_int64),
        ("bytes", POINTER(c_uint8)),
        ("length", c_size_t),
        ("valid", c_bool),
        ("text", c_char_p),
    ]


class FmsAnswer(Structure):
    _fields_ = [("end", c_int32), ("code", c_uint32), ("data", POINTER(c_uint8)), ("length", c_size_t), ("text", c_char_p)]


class Entry(Structure):
    _fields_ = [("time", c_int64), ("weight", c_int32), ("station", c_char_p), ("text", c_char_p)]


CONDITION = CFUNCTYPE(c_bool, c_void_p, c_void_p)

# ipos_plant_... and the types of its arguments; all of these return a status.
_FUNCTIONS = {
    "open": [POINTER(Source), POINTER(c_void_p)],
    "close": [c_void_p],
    "adopt": [c_void_p],
    "mistake_at": [c_void_p, c_size_t, POINTER(MistakeRow)],
    "duration": [c_char_p, POINTER(c_int64)],
    "time": [c_void_p, POINTER(c_int64)],
    "run": [c_void_p, c_int64],
    "run_to_frame": [c_void_p, c_uint32, c_int64],
    "run_until": [c_void_p, c_int64, CONDITION, c_void_p],
    "station_at": [c_void_p, c_uint32, POINTER(StationInfo)],
    "station": [c_void_p, c_char_p, POINTER(c_uint32)],
    "ideal_motor": [c_void_p, c_uint32, POINTER(c_bool)],
    "power": [c_void_p, c_uint32, c_bool],
    "program": [c_void_p, c_uint32, c_int32],
    "drive_fault": [c_void_p, c_uint32, c_uint8],
    "reset_fault": [c_void_p, c_uint32],
    "why": [c_void_p, c_uint32, POINTER(c_char_p)],
    "find": [c_void_p, c_uint32, c_int32, c_char_p, POINTER(c_uint32)],
    "signal_info_of": [c_void_p, c_uint32, POINTER(SignalInfo)],
    "name_at": [c_void_p, c_uint32, c_int32, c_char_p, c_uint32, POINTER(c_char_p)],
    "read": [c_void_p, c_uint32, POINTER(c_int64)],
    "read_many": [c_void_p, POINTER(c_uint32), c_size_t, POINTER(c_int64)],
    "read_text": [c_void_p, c_uint32, POINTER(c_char_p)],
    "write": [c_void_p, c_uint32, c_int64],
    "write_text": [c_void_p, c_uint32, c_char_p],
    "force": [c_void_p, c_uint32, c_int64],
    "force_text": [c_void_p, c_uint32, c_char_p],
    "release": [c_void_p, c_uint32],
    "bus_at": [c_void_p, c_uint32, POINTER(BusInfo)],
    "bus": [c_void_p, c_char_p, POINTER(c_uint32)],
    "bus_load": [c_void_p, c_uint32, POINTER(Load)],
    "join": [c_void_p, c_uint32],
    "send": [c_void_p, c_uint32, POINTER(FrameRow), POINTER(c_uint32)],
    "receive": [c_void_p, c_uint32, POINTER(FrameRow), c_size_t, POINTER(c_size_t)],
    "node_name": [c_void_p, c_uint32, c_uint32, POINTER(c_char_p)],
    "serial_send": [c_void_p, c_uint32, c_char_p, c_size_t],
    "serial_receive": [c_void_p, c_uint32, POINTER(TelegramRow)],
    "fms": [c_void_p, c_uint32, c_uint8, c_uint8, c_char_p, c_uint16, c_char_p, c_size_t, c_int64, POINTER(FmsAnswer)],
    "line_fault": [c_void_p, c_char_p],
    "parameter_index": [c_char_p, c_char_p, POINTER(c_uint16)],
    "parameter_text": [c_char_p, c_uint16, c_int32, c_char_p, c_size_t],
    "parameter_value": [c_char_p, c_uint16, c_char_p, POINTER(c_int32), c_char_p, c_size_t],
    "unit_signs": [c_size_t, POINTER(c_char_p), POINTER(c_uint16), POINTER(c_size_t)],
    "journal_at": [c_void_p, c_size_t, POINTER(Entry)],
    "save": [c_void_p, c_void_p, POINTER(c_size_t)],
    "restore": [c_void_p, c_char_p, c_size_t],
    "restart": [c_void_p],
    "replay": [c_void_p, CONDITION, c_void_p],
    "trace_hash": [c_void_p, POINTER(c_uint64)],
}

# Those that return something else.
_ANSWERS = {
    "message": ([c_void_p], c_char_p),
    "mistakes": ([c_void_p], c_size_t),
    "status_text": ([c_int32], c_char_p),
    "return_code": ([c_uint32], c_char_p),
    "unit_name": ([c_size_t], c_char_p),
    "version": ([], c_uint32),
}


def _typed(name: str, argtypes: list, restype: type):
    found = getattr(_library, "ipos_plant_" + name)
    found.argtypes, found.restype = argtypes, restype
    return found


_library = _load()
_functions = {name: _typed(name, types, c_int32) for name, types in _FUNCTIONS.items()}
_functions |= {name: _typed(name, *types) for name, types in _ANSWERS.items()}

OK, NOT_REACHED, INVALID_ARGUMENT, BAD_PLANT, NOT_OPEN, OTHER_THREAD, BUSY, NO_STATION, NO_SIGNAL, NO_BUS = range(10)
READ_ONLY, BAD_VALUE, REFUSED, BAD_STATE, OTHER_PLANT, NOT_RECORDED, TOO_SMALL = range(10, 17)
OUT_OF_MEMORY, BROKEN, NOTHING, FULL = range(17, 21)

ANY, VARIABLE, PARAMETER, INPUT, OUTPUT, ANALOG, STATE, WORD, SIGNAL, SHAFT = range(10)
LINE = 0x80000000  # IPOS_PLANT_LINE

EXTENDED, REMOTE, ERROR, OWN = 1, 2, 4, 8
WRITE_MEMORY, NO_RECORD = 1, 2
# Of error frames, linux/can/error.h: classes in the identifier, and the passive bits in data[1].
CONTROLLER = {"controller": 0x004, "bus off": 0x040, "restarted": 0x100}
PASSIVE = 0x30
WRITABLE = 1


class Mistake:
    """One mistake of a plant file or a program: file, line, column, text. Lines and columns count from 1."""

    __slots__ = ("file", "line", "column", "text")

    def __init__(self, file: str, line: int, column: int, text: str) -> None:
        self.file, self.line, self.column, self.text = file, line, column, text

    def __str__(self) -> str:
        place = f"{self.file}:{self.line}:{self.column}" if self.line else self.file
        return f"{place}: {self.text}"

    def __repr__(self) -> str:
        return f"<Mistake {self}>"


class PlantError(Exception):
    """Something a plant refuses. `.errors` are the mistakes of a plant that could not be opened, else empty."""

    def __init__(self, text: str, errors: tuple[Mistake, ...] | list[Mistake] = ()) -> None:
        super().__init__(text)
        self.errors = list(errors)


class RefusedError(PlantError):
    """The unit or the line has refused a value or an order; the text says why, with the return code."""


class QueueFullError(RefusedError):
    """So many frames wait to be sent that there is no room for one more. There is when one of them has gone."""


class ThreadError(PlantError, RuntimeError):
    """The plant belongs to another thread, or a call of it is under way."""


class ClosedError(PlantError, ValueError):
    """The plant is closed."""


def text(value: bytes | None) -> str:
    return "" if value is None else value.decode("utf-8", "replace")


def status_text(status: int) -> str:
    return text(function("status_text")(status))


def version() -> str:
    """Version of the library."""
    number = function("version")()
    return f"{number // 10000}.{number // 100 % 100}.{number % 100}"


class _Words(KeyError):
    """A KeyError whose text is shown as it is, without quotes around it, under the name that people know."""

    __module__ = "builtins"

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


_Words.__name__ = _Words.__qualname__ = "KeyError"


def unknown(what: str) -> KeyError:
    """The KeyError of a name that leads nowhere; its text says what there is."""
    return _Words(what)


class Named(Mapping):
    """What has things by name: dict(), keys(), items() and get() work, and [ completes in a notebook."""

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def _ipython_key_completions_(self) -> list[str]:
        return list(self)


def encoded(value: object, is_path: bool = False) -> bytes:
    """A text as the library takes it: the one way for every text that is handed over."""
    if not isinstance(value, str):
        raise TypeError(f"this is a text, not {type(value).__name__}")
    if "\0" in value:
        raise ValueError("a text with a zero character names nothing")
    return os.fsencode(value) if is_path else value.encode("utf-8", "surrogateescape")


def error_of(status: int, message: str) -> Exception:
    said = message or status_text(status)
    if status in (NO_STATION, NO_SIGNAL, NO_BUS):
        return unknown(said)
    if status == READ_ONLY:
        return TypeError(said)
    if status in (BAD_VALUE, INVALID_ARGUMENT):
        return ValueError(said)
    if status == REFUSED:
        return RefusedError(said)
    if status == FULL:
        return QueueFullError(said)
    if status == OTHER_THREAD:
        return ThreadError("the plant belongs to another thread; plant.adopt() takes it over")
    if status == BUSY:
        return ThreadError(status_text(status))
    if status == OUT_OF_MEMORY:
        return MemoryError(status_text(status))
    return PlantError(status_text(status) if status in (BROKEN, NOT_RECORDED) else said)


def function(name: str):
    """The function ipos_plant_`name` as it is."""
    return _functions[name]


def duration_ns(value: object) -> int:
    """A duration: a text with unit ("500ms"), or a number of seconds."""
    if isinstance(value, str):
        ns = c_int64()
        if function("duration")(encoded(value), byref(ns)) != OK:
            raise ValueError(f"'{value}' is no time; write for example 500ms or 1.5s")
        return ns.value
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise TypeError(f"a time is a text such as '500ms' or a number of seconds, not {type(value).__name__}")
    if not 0 <= value <= 9e9:
        raise ValueError(f"{value} seconds are no duration")
    return round(value * 1e9)
