"""A bus of a plant: frames of a CAN line, telegrams of an RS-485 or PROFIBUS line."""

from __future__ import annotations

from collections import deque
from ctypes import byref, c_size_t, c_uint8, c_uint32
from typing import TYPE_CHECKING

from . import _library as lib
from ._signals import SignalOwner
from .fms import Fms

if TYPE_CHECKING:
    from .plant import Plant

_AT_A_TIME = 256
_LAST = 32


class Frame:
    """A CAN frame as it was on the line. `time` is the end of its last bit, in seconds of virtual time."""

    __slots__ = ("time", "id", "data", "extended", "remote", "error", "own", "length", "sender", "tag")

    def __init__(self, row: lib.FrameRow, sender: str) -> None:
        self.time: float = row.time / 1e9
        self.id: int = row.id
        self.length: int = row.length
        self.remote = bool(row.flags & lib.REMOTE)
        self.data: bytes = b"" if self.remote else bytes(row.data[: row.length])
        self.extended = bool(row.flags & lib.EXTENDED)
        self.error = bool(row.flags & lib.ERROR)
        self.own = bool(row.flags & lib.OWN)
        self.sender = sender
        self.tag: int = row.tag

    def __repr__(self) -> str:
        digits = 8 if self.extended or self.error else 3
        what = f"R{self.length}" if self.remote else self.data.hex().upper()
        return f"<Frame {self.time * 1e3:.3f} ms {self.id:0{digits}X}#{what} from {self.sender or 'nobody'}>"


class Telegram:
    """A telegram of an RS-485 line or a frame of a PROFIBUS line: bytes, what they say, and whether they are valid."""

    __slots__ = ("start", "time", "data", "valid", "text")

    def __init__(self, row: lib.TelegramRow) -> None:
        self.start: float = row.start / 1e9
        self.time: float = row.end / 1e9
        self.data: bytes = bytes(row.bytes[: row.length]) if row.length else b""
        self.valid = bool(row.valid)
        self.text: str = lib.text(row.text)

    def __repr__(self) -> str:
        return f"<Telegram {self.time * 1e3:.3f} ms {self.data.hex(' ').upper()}: {self.text}>"


class Bus(SignalOwner):
    """plant.buses["sbus"]."""

    def __init__(self, plant: "Plant", number: int, info: lib.BusInfo) -> None:
        super().__init__(plant, lib.LINE + number)
        self._number = number
        self.name = lib.text(info.name)
        self.kind = ("can", "serial", "profibus")[info.kind]
        self.baud: int = info.baud
        self._senders: dict[int, str] = {}
        self.last: "deque[Frame | Telegram]" = deque(maxlen=_LAST)  # of those that were given

    def __repr__(self) -> str:
        if self._plant._closed:
            return f"<Bus {self.name} of a closed plant>"
        return f"<Bus {self.name}: {self.kind}, {self.baud} baud, load {self.load:.2f} %>"

    def send(self, id: int | bytes, data: bytes = b"", *, extended: bool = False, remote: bool = False, length: int | None = None) -> int:
        """Queues a frame: bus.send(0x20B, bytes([1, 2])). On the other lines: bus.send(bytes). Returns the tag of a frame."""
        if self.kind != "can":
            if not isinstance(id, (bytes, bytearray)) or data:
                raise TypeError(f"on a {self.kind} line bytes are sent: bus.send(bytes)")
            self._plant._call("serial_send", self._number, bytes(id), len(id))
            return 0
        if isinstance(id, bool) or not isinstance(id, int):
            raise TypeError(f"an identifier is a whole number, not {type(id).__name__}")
        data = bytes(data) if not isinstance(data, int) else _no_number()
        row = lib.FrameRow()
        if not 0 <= id < 2**29 or len(data) > 8:
            raise ValueError("a frame has 8 bytes at most and an identifier of 11 or, extended, 29 bits")
        if length is not None and (not remote or not isinstance(length, int) or not 0 <= length <= 8):
            raise ValueError("length is what a remote frame asks for, 0 to 8")
        row.id = id
        row.flags = (lib.EXTENDED if extended else 0) | (lib.REMOTE if remote else 0)
        row.length = len(data) if length is None else length
        row.data = (c_uint8 * 8)(*data)
        tag = c_uint32()
        self._plant._call("send", self._number, byref(row), byref(tag))
        return tag.value

    def fms(self, address: int, *, connection: int = 7, limit: str | float = "10s") -> Fms:
        """Services of PROFIBUS-FMS of the station at an address, with a master that joins the ring: bus.fms(8).read(1025)."""
        if self.kind != "profibus":
            raise TypeError(f"FMS is on PROFIBUS lines, {self.name} is {self.kind}")
        return Fms(self, address, connection, limit)

    def to_pandas(self) -> object:
        """What frames() gives as a pandas.DataFrame, a row a frame or telegram."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_pandas() needs pandas; bus.frames() has the same") from None
        columns = list((Frame if self.kind == "can" else Telegram).__slots__)
        return pandas.DataFrame([[getattr(row, name) for name in columns] for row in self.frames()], columns=columns)

    def join(self) -> None:
        """Takes part in a CAN line: acknowledges frames, also before the first one is sent."""
        self._plant._call("join", self._number)

    def frames(self, *, errors: bool = False) -> list[Frame] | list[Telegram]:
        """What the bus has carried since the last call, own frames included; telegrams of the other lines.

        errors=True: error frames of the line, too, with the classes of SocketCAN in their id.
        """
        if self.kind != "can":
            return self.telegrams()
        found: list[Frame] = []
        rows = (lib.FrameRow * _AT_A_TIME)()
        count = c_size_t()
        while True:
            self._plant._call("receive", self._number, rows, _AT_A_TIME, byref(count))
            for row in rows[: count.value]:
                if errors or not row.flags & lib.ERROR:
                    found.append(Frame(row, self._sender(row.sender)))
            if count.value < _AT_A_TIME:
                self.last.extend(found[-_LAST:])
                return found

    def telegrams(self) -> list[Telegram]:
        """The telegrams of an RS-485 line, or the frames of a PROFIBUS line, since the last call."""
        found: list[Telegram] = []
        row = lib.TelegramRow()
        with self._plant._gate as handle:
            while True:
                status = lib.function("serial_receive")(handle, self._number, byref(row))
                if status == lib.NOTHING:
                    self.last.extend(found[-_LAST:])
                    return found
                if status != lib.OK:
                    raise self._plant._error(status)
                found.append(Telegram(row))

    def __getitem__(self, name: str) -> float:
        """What a telegram carried last: bus["013.PO2"]; also "load" and "count". A telegram is kept from the first look on."""
        signal = self._find(lib.SIGNAL, name)
        return self._read(signal) * self._scale(signal).factor

    @property
    def load(self) -> float:
        """How busy the line was since power-on, in percent."""
        return self._load().percent

    @property
    def count(self) -> int:
        """Frames the line has carried; of an RS-485 line characters."""
        return self._load().frames

    @property
    def lost(self) -> int:
        """Frames that were thrown away unread: the last 100 000 are kept."""
        return self._load().lost

    def _load(self) -> lib.Load:
        load = lib.Load()
        self._plant._call("bus_load", self._number, byref(load))
        return load

    def _sender(self, node: int) -> str:
        if node == 0xFFFFFFFF:
            return ""
        if node not in self._senders:
            self._senders[node] = self._plant._text("node_name", self._number, node)
        return self._senders[node]


def _no_number() -> bytes:
    raise TypeError("data is bytes, not a number")
