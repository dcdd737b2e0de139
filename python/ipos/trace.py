"""Traces that `ipos run --trace FILE.ipos-trace` has written.

    import ipos.trace

    trace = ipos.trace.read("run.ipos-trace")
    print(trace.times[-1], trace["saw.speed"][-1], trace.events)

Nothing but Python's own library reads them. Of a run that was killed there is all but its last moments; `ends_early` says so.
"""

from __future__ import annotations

import json
import os
import zlib
from itertools import repeat
from struct import Struct
from typing import Any, Iterator, NamedTuple

from .recording import Recording

_MAGIC = b"\x89IPOStrc\r\n\x1a\n"
_VERSION = 1
_HEADER = Struct("<cBxxII")
_CHECKSUM = Struct("<I")
_HEAD, _ROWS, _END = b"H", b"R", b"E"
_MOST_CONTENT = 1 << 28
_MOST_ROWS = 1 << 20
_STORED, _ZLIB = 0, 1


class TraceError(ValueError):
    """A file that is no such trace, or a damaged one; `offset` is the byte from which on it cannot be read."""

    def __init__(self, path: str, offset: int, text: str) -> None:
        super().__init__(f"{path}: byte {offset}: {text}")
        self.offset = offset


class Event(NamedTuple):
    time: float  # s
    text: str
    is_fault: bool


class Frame(NamedTuple):
    """A frame of CAN, with its identifier, or a telegram of another bus, with what it says."""

    time: float  # s, of its end
    bus: str
    id: "int | None"
    is_extended: bool
    is_remote: bool
    data: bytes
    text: str


class Trace(Recording):
    """A recording with the events of its stations and the frames of its buses, as far as they were asked for."""

    def __init__(self, head: dict[str, Any]) -> None:
        signals = head["signals"]
        self.names = tuple(signal["name"] for signal in signals)
        self.units = tuple(signal["unit"] for signal in signals)
        self.times = []
        self._columns = [[] for _ in signals]
        self._factors = [signal["factor"] for signal in signals]
        self._tracks = [(track["bus"], track["can"]) for track in head["tracks"]]
        self.events: list[Event] = []
        self.frames: list[Frame] = []
        self.program: str = head.get("program", "")
        self.ends_early = False

    def _take_rows(self, numbers: "_Numbers") -> None:
        before = len(self.times)
        time = 0
        for _ in range(numbers.number()):
            gap, step, count = numbers.number(), numbers.number(), numbers.number()
            if count == 0 or len(self.times) - before + count > _MOST_ROWS:
                raise ValueError("the block has a number of rows that it cannot have")
            self.times.extend(ns / 1e9 for ns in _steps(time + gap, step, count))
            time += gap + step * (count - 1)
        rows = len(self.times) - before
        for column, factor in zip(self._columns, self._factors):
            _take_column(_Numbers(numbers.text()), rows, factor, column)
        time = 0
        for _ in range(numbers.number()):
            time += numbers.number()
            fault = numbers.byte()
            self.events.append(Event(time / 1e9, numbers.text().decode(errors="replace"), fault != 0))
        time = 0
        for _ in range(numbers.number()):
            time += numbers.number()
            bus, is_can = self._tracks[numbers.number()]
            flags, id_, data = numbers.byte(), numbers.number(), numbers.text()
            extended, remote = bool(flags & 1), bool(flags & 2)
            text = numbers.text().decode(errors="replace") if flags & 4 else _usual(id_, extended, remote, data) if is_can else ""
            self.frames.append(Frame(time / 1e9, bus, id_ if is_can else None, extended, remote, data, text))
        if not numbers.at_end():
            raise ValueError("the block goes on behind its frames")


def read(path: "str | os.PathLike[str]") -> Trace:
    """Reads a whole trace. TraceError: it is none, or damaged; OSError: it cannot be read."""
    name = os.fspath(path)
    with open(name, "rb") as file:
        data = file.read()
    if not data.startswith(_MAGIC):
        raise TraceError(name, 0, "this is no .ipos-trace")
    begin = len(_MAGIC)
    version = int.from_bytes(data[begin : begin + 4], "little")
    if len(data) < begin + 4 or version != _VERSION:
        raise TraceError(name, begin, f"the trace is of version {version}, and this package reads version {_VERSION}")
    trace = None
    kind = b""
    end = begin + 4
    for offset, end, kind, content in _blocks(name, data, begin + 4):
        try:
            if trace is None:
                if kind != _HEAD:
                    raise ValueError("the first block is not the head")
                trace = Trace(json.loads(content))
            elif kind == _ROWS:
                trace._take_rows(_Numbers(content))
            elif kind != _END:
                raise ValueError("there is a second head")
        except (ValueError, LookupError, TypeError, OverflowError) as reason:
            raise TraceError(name, offset, str(reason) or "the block is damaged") from None
        if kind == _END:
            break
    if trace is None:
        raise TraceError(name, end, "the file ends before it says what was recorded")
    if kind == _END and end != len(data):
        raise TraceError(name, end, f"{len(data) - end} bytes stand behind the last block")
    trace.ends_early = kind != _END
    return trace


def _blocks(name: str, data: bytes, at: int) -> Iterator[tuple[int, int, bytes, bytes]]:
    """Offset, offset of what follows, kind and content of each block that is whole."""
    while len(data) - at >= _HEADER.size + _CHECKSUM.size:
        kind, packing, length, size = _HEADER.unpack_from(data, at)
        body = at + _HEADER.size
        end = body + length + _CHECKSUM.size
        if end > len(data):
            return
        if zlib.crc32(data[at : body + length]) != _CHECKSUM.unpack_from(data, body + length)[0]:
            raise TraceError(name, at, "the block is damaged: its checksum differs")
        content = data[body : body + length]
        if packing == _ZLIB and size <= _MOST_CONTENT:
            unpacking = zlib.decompressobj()
            try:
                content = unpacking.decompress(content, size + 1)
            except zlib.error:
                content = b""
        if packing not in (_STORED, _ZLIB) or kind not in (_HEAD, _ROWS, _END) or len(content) != size:
            raise TraceError(name, at, "the block is of a kind, a packing or a length that no block has")
        yield at, end, kind, content
        at = end


class _Numbers:
    """Numbers of seven bits a byte, and texts behind their length."""

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def byte(self) -> int:
        if self._at >= len(self._data):
            raise ValueError("the block ends within a number or a text")
        self._at += 1
        return self._data[self._at - 1]

    def number(self) -> int:
        value = shift = 0
        while True:
            byte = self.byte()
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                break
            shift += 7
        if value >> 64:
            raise ValueError("a number has more than 64 bits")
        return value

    def signed(self) -> int:
        value = self.number()
        return -(value >> 1) - 1 if value & 1 else value >> 1

    def text(self) -> bytes:
        length = self.number()
        if length > len(self._data) - self._at:
            raise ValueError("the block ends within a number or a text")
        self._at += length
        return self._data[self._at - length : self._at]

    def at_end(self) -> bool:
        return self._at == len(self._data)


def _steps(first: int, step: int, count: int) -> "range | repeat[int]":
    return range(first, first + step * count, step) if step else repeat(first, count)


def _take_column(numbers: _Numbers, rows: int, factor: float, column: list[float]) -> None:
    """The samples of a signal in each row of a block, as numbers that people read."""
    value = numbers.signed()
    runs = [(numbers.number(), numbers.number()) for _ in range(numbers.number())]
    if sum(skipped + count for skipped, count in runs) > rows:
        raise ValueError("a column changes in rows that are not there")
    begin = len(column)
    for skipped, count in runs:
        column.extend(repeat(value if factor == 1 else value * factor, skipped))
        step = 0
        for _ in range(count):
            step += numbers.signed()
            value = (value + step + 2**63) % 2**64 - 2**63
            column.append(value if factor == 1 else value * factor)
    column.extend(repeat(value if factor == 1 else value * factor, begin + rows - len(column)))
    if not numbers.at_end():
        raise ValueError("a column has another length than it says")


def _usual(id_: int, extended: bool, remote: bool, data: bytes) -> str:
    return f"{id_:0{8 if extended else 3}X}#" + ("R" if remote else data.hex().upper())
