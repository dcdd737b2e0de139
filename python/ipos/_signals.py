"""What has signals: a station with its gateways, or a line."""

from __future__ import annotations

from ctypes import byref, c_int64, c_uint32
from typing import TYPE_CHECKING, NamedTuple

from . import _library as lib

if TYPE_CHECKING:
    from .plant import Plant


class Scale(NamedTuple):
    """How people read the numbers of a signal: times `factor`, in `unit`."""

    factor: float
    unit: str


class SignalOwner:
    """Finds signals once and reads them. `place` is the station's number; that of a line is lib.LINE + its own."""

    def __init__(self, plant: "Plant", place: int) -> None:
        self._plant, self._place = plant, place
        self._found: dict[tuple[int, str], int] = {}

    def _find(self, kind: int, name: object) -> int:
        found = self._found.get((kind, name))  # type: ignore[arg-type]
        if found is not None:
            return found
        signal = c_uint32()
        self._plant._call("find", self._place, kind, lib.encoded(name), byref(signal))
        self._found[(kind, name)] = signal.value  # type: ignore[index]
        return signal.value

    def _scale(self, signal: int) -> Scale:
        info = lib.SignalInfo()
        with self._plant._gate:
            self._plant._call("signal_info_of", signal, byref(info))
            return Scale(info.factor, lib.text(info.unit))

    def _read(self, signal: int) -> int:
        value = c_int64()
        self._plant._call("read", signal, byref(value))
        return value.value
