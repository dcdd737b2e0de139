"""PROFIBUS-FMS of a station: plant.buses["dp"].fms(8)."""

from __future__ import annotations

from ctypes import byref
from typing import TYPE_CHECKING

from . import _library as lib

if TYPE_CHECKING:
    from .bus import Bus


class FmsError(Exception):
    """A negative answer of a service: `code` is class, code and additional code of an error, else 0."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        self.code = code


class Fms:
    """Services over one connection. Each lets the plant run until its answer is there."""

    def __init__(self, bus: "Bus", address: int, connection: int, limit: str | float) -> None:
        self._bus, self._address, self._connection, self._limit = bus, address, connection, limit

    def read(self, index: int) -> bytes:
        return self._ask("read", index)[0]

    def write(self, index: int, data: bytes) -> None:
        self._ask("write", index, bytes(data))

    def describe(self, index: int) -> str:
        """The object description in words."""
        return self._ask("ov", index)[1]

    def identify(self) -> str:
        return self._ask("identify")[1]

    def status(self) -> bytes:
        return self._ask("status")[0]

    def initiate(self) -> None:
        self._ask("initiate")

    def abort(self) -> None:
        self._ask("abort")

    def _ask(self, service: str, index: int = 0, data: bytes = b"") -> tuple[bytes, str]:
        plant = self._bus._plant
        if not 0 <= index <= 0xFFFF:
            raise ValueError(f"{index} is no index of an object")
        if not 0 <= self._address <= 125:
            raise ValueError(f"{self._address} is no address of PROFIBUS")
        answer = lib.FmsAnswer()
        with plant._gate as handle:
            until = plant._now() + lib.duration_ns(self._limit)
            status = lib.function("fms")(handle, self._bus._number, self._address, self._connection, service.encode(), index, data,
                                         len(data), until, byref(answer))
            if status == lib.NOTHING:
                raise FmsError(f"no answer within {self._limit}", 0)
            if status != lib.OK:
                raise plant._error(status)
            text = lib.text(answer.text)
            if answer.end != 0:
                raise FmsError(text, answer.code)
            return bytes(answer.data[: answer.length]) if answer.length else b"", text
