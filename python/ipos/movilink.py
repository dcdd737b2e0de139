"""MOVILINK to drives: parameter channel and process data over SBus (any python-can bus: SocketCAN, slcan, or a plant) and RS-485.

    with can.Bus(interface="socketcan", channel="can0") as bus:
        drive = ipos.movilink.Drive(ipos.movilink.Sbus(bus), address=1)
        print(drive["P130"], drive.status_word)
        drive["P130"] = "2.5 s"

The same lines run on a simulated line with can.Bus(interface="ipos", channel="line.toml#sbus"). What a drive refuses is a
RefusedError with its return code. Telegrams: SEW 1053 1610 p. 18-25 and 29-46.
"""

from __future__ import annotations

import time
from ctypes import byref, c_char_p, c_int32, c_size_t, c_uint16, create_string_buffer
from itertools import count
from typing import Any, Callable, Iterator, NamedTuple, Optional, Protocol

from . import _library as lib
from .station import ParameterValue

READ, WRITE, WRITE_VOLATILE, READ_MINIMUM, READ_MAXIMUM, READ_DEFAULT = 1, 2, 3, 4, 5, 6

_FOUR_BYTES, _FAILED, _SERVICE = 0x30, 0x80, 0x0F
_FIRST_VARIABLE = 11000
_STATUS = 8310  # status word 1 in the low word
_FIRMWARE = 8300
LONGEST_SILENCE = 500  # ms, of a drive's monitoring that ends a movement in time (ours)


def _unit_names() -> Iterator[str]:
    for number in count():
        name = lib.function("unit_name")(number)
        if name is None:
            return
        yield lib.text(name)


def _signs() -> Iterator[tuple[str, tuple[int, ...]]]:
    """Unit types in the order in which they are asked for, with the indices that a unit of the type can read."""
    unit, indices = c_char_p(), (c_uint16 * 8)()
    for number in count():
        size = c_size_t(len(indices))
        if lib.function("unit_signs")(number, byref(unit), indices, byref(size)) != lib.OK:
            return
        yield lib.text(unit.value), tuple(indices[: size.value])


class NoAnswerError(lib.PlantError, TimeoutError):
    """No drive has answered."""


class DriveRefusedError(lib.RefusedError):
    """The drive has refused a service. `.code` are the four bytes of its return code."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        self.code = code


class UnmonitoredError(lib.PlantError):
    """Process data that could enable a drive which does not monitor them: it would move on when nobody sends any more."""


class Monitoring(NamedTuple):
    """A drive's own monitoring of process data, as names and indices of its parameters. `address` has the drive's own
    address on the line that it monitors; None: there is one line only."""

    address: Optional[int]
    delay_name: str
    delay: int
    response_name: str
    response: int


class Line(Protocol):
    """What carries the eight bytes of the parameter channel, or process data words, to a unit and its answer back; None: no
    answer. `monitoring`: what monitors the words of such a line in a drive."""

    addresses: range
    monitoring: tuple[Monitoring, ...]

    def exchange(self, address: int, request: bytes) -> Optional[bytes]: ...

    def exchange_words(self, address: int, words: bytes) -> Optional[bytes]: ...


class Sbus:
    """SBus, over a bus of python-can. `timeout` in seconds; a plant counts it in virtual time."""

    addresses = range(64)
    # P813 or P881; P891 of the second SBus, which a MOVIDRIVE B has.
    monitoring = (
        Monitoring(8600, "P815 (P883 of MOVIDRIVE B)", 8602, "P836", 8615),
        Monitoring(8932, "P893", 8934, "P837", 8936),
    )

    def __init__(self, bus: Any, timeout: float = 0.08) -> None:
        self.bus, self.timeout = bus, timeout

    def exchange(self, address: int, request: bytes) -> Optional[bytes]:
        return self._ask(512 + 8 * address + 3, request, lambda data: len(data) == 8 and data[2:4] == request[2:4])

    def exchange_words(self, address: int, words: bytes) -> Optional[bytes]:
        return self._ask(8 * address + 3, words.ljust(6, b"\0"), lambda data: len(data) == 6)

    def _ask(self, asked: int, request: bytes, answers: Callable[[bytes], bool]) -> Optional[bytes]:
        import can

        self.bus.send(can.Message(arbitration_id=asked, data=request, is_extended_id=False))
        begin = last = None
        left = self.timeout
        clock = time.monotonic()
        while left > 0:
            message = self.bus.recv(left)
            if message is None:
                return None
            if message.arbitration_id == asked + 1 and not message.is_extended_id and not message.is_error_frame:
                if answers(bytes(message.data)):
                    return bytes(message.data)
            # Time is that of the frames where they come one after the other at once, else that of the clock.
            begin = message.timestamp if begin is None else begin
            last = message.timestamp
            left = self.timeout - max(last - begin, time.monotonic() - clock)
        return None


class Serial:
    """RS-485 or RS-232 at 9600 baud, 8E1, over an open port with read(count) and write(bytes), as pyserial has it."""

    addresses = range(100)
    monitoring = (Monitoring(None, "P812", 8599, "P833", 8612),)
    _TYP = 0x86  # parameter channel, acyclic
    _TRIES = 5
    _WORDS_TYP = {2: 0x01, 4: 0x03, 6: 0x05}  # cyclic: acyclic telegrams are not monitored (1053 1610 p. 23)
    _PAUSE = 0.004  # s before a telegram: a start pause is 3.44 ms

    def __init__(self, port: Any, timeout: float = 0.1, sleep: Callable[[float], None] = time.sleep) -> None:
        self.port, self.timeout, self._sleep = port, timeout, sleep
        self._set_timeout()

    def _set_timeout(self) -> None:
        """pyserial sets the whole port anew for it. A pseudo-terminal may refuse that while the program on its other side
        takes over the settings of the open: then the same is right a moment later."""
        if getattr(self.port, "timeout", self.timeout) == self.timeout:
            return
        for left in reversed(range(self._TRIES)):
            try:
                self.port.timeout = self.timeout
                return
            except Exception:  # termios.error, which is no OSError, or an error of pyserial
                if not left:
                    raise
                self._sleep(0.002)

    def exchange(self, address: int, request: bytes) -> Optional[bytes]:
        answer = self._ask(address, self._TYP, request)
        return answer if answer is not None and answer[2:4] == request[2:4] else None

    def exchange_words(self, address: int, words: bytes) -> Optional[bytes]:
        return self._ask(address, self._WORDS_TYP[len(words)], words)

    def _ask(self, address: int, typ: int, request: bytes) -> Optional[bytes]:
        if hasattr(self.port, "reset_input_buffer"):
            self.port.reset_input_buffer()
        self._sleep(self._PAUSE)
        self.port.write(_checked(bytes([0x02, address, typ]) + request))
        length = 3 + len(request) + 1
        answer = self.port.read(length)
        if len(answer) == length and answer[0] == 0x02:  # an adapter that hears itself
            answer = self.port.read(length)
        if len(answer) != length or answer[:3] != bytes([0x1D, address, typ]) or _checked(answer[:-1]) != answer:
            return None
        return answer[3:-1]


def _checked(telegram: bytes) -> bytes:
    """With its block check character: all bytes by exclusive or."""
    check = 0
    for byte in telegram:
        check ^= byte
    return telegram + bytes([check])


class Drive:
    """The unit at an address of a line. `unit` is its type ("mdxb"); without, it is asked."""

    def __init__(self, line: Line, address: int, unit: Optional[str] = None, tries: int = 3) -> None:
        if address not in line.addresses:
            raise ValueError(f"an address is {line.addresses.start} to {line.addresses.stop - 1}, not {address}")
        self.line, self.address, self.tries = line, address, tries
        self._monitored_until = 0.0
        self.unit = unit or self._identify()
        self.index_of("8300")  # a type that has no list is refused here

    def __repr__(self) -> str:
        return f"<Drive {self.unit} at {self.address}>"

    def execute(self, service: int, index: int, value: int = 0) -> int:
        """A service of the parameter channel. A read that was not answered is repeated, a write is not."""
        request = bytes([_FOUR_BYTES | service, 0]) + index.to_bytes(2, "big") + (value & 0xFFFFFFFF).to_bytes(4, "big")
        for _ in range(1 if service in (WRITE, WRITE_VOLATILE) else self.tries):
            answer = self.line.exchange(self.address, request)
            if answer is None:
                continue
            data = int.from_bytes(answer[4:], "big")
            if not answer[0] & _FAILED:
                return data - (1 << 32) if data >> 31 else data
            words = lib.text(lib.function("return_code")(data)) or f"return code {data:08X}"
            raise DriveRefusedError(f"index {index}: {words}", data)
        raise NoAnswerError(f"unit {self.address} does not answer")

    def _identify(self) -> str:
        answers: dict[int, bool] = {}  # each index is asked once
        for unit, indices in _signs():
            for index in indices:
                if index not in answers:
                    answers[index] = self._reads(index)
                if not answers[index]:
                    break
            else:
                return unit
        raise lib.PlantError(f"unit {self.address} answers, but has none of the parameters that tell its type; give unit=")

    def _reads(self, index: int) -> bool:
        try:
            self.execute(READ, index)
        except DriveRefusedError:
            return False
        return True

    def index_of(self, name: str | int) -> int:
        """ "P130", an index, or a variable "H20"."""
        if isinstance(name, int) and not isinstance(name, bool):
            return name
        if isinstance(name, str) and name[:1] == "H" and name[1:].isdigit() and int(name[1:]) < 1024:
            return _FIRST_VARIABLE + int(name[1:])
        index = c_uint16()
        status = lib.function("parameter_index")(lib.encoded(self.unit), lib.encoded(name), byref(index))
        if status == lib.NO_STATION:
            raise ValueError(f"'{self.unit}' is no unit type; known are {', '.join(_unit_names())}")
        if status != lib.OK:
            raise lib.unknown(f"unit {self.unit} has no parameter '{name}'")
        return index.value

    def __getitem__(self, name: str | int) -> ParameterValue:
        index = self.index_of(name)
        value = ParameterValue(self.execute(READ, index))
        room = create_string_buffer(200)
        known = lib.function("parameter_text")(lib.encoded(self.unit), index, value, room, len(room)) == lib.OK
        value.name, value.text = str(name), lib.text(room.value) if known else str(int(value))
        return value

    def __setitem__(self, name: str | int, value: str | int) -> None:
        self.write(name, value)

    def write(self, name: str | int, value: str | int, volatile: bool = True) -> None:
        """Writes a parameter or variable; with volatile=False the unit stores it, which wears its memory."""
        index = self.index_of(name)
        if isinstance(value, str):
            number, room = c_int32(), create_string_buffer(500)
            status = lib.function("parameter_value")(
                lib.encoded(self.unit), index, lib.encoded(value), byref(number), room, len(room)
            )
            if status != lib.OK:
                raise ValueError(f"{name}: {lib.text(room.value) or lib.status_text(status)}")
            value = number.value
        if isinstance(value, bool) or not isinstance(value, int):
            raise TypeError(f"a parameter takes a text with unit or a whole number, not {type(value).__name__}")
        if not -(2**31) <= value < 2**32:
            raise ValueError(f"{value} is out of range")
        self.execute(WRITE_VOLATILE if volatile else WRITE, index, value)

    def send_process_data(self, *words: int) -> tuple[int, ...]:
        """One to three process output data words to the unit; returns as many of its input data. A drive that monitors
        them wants them again and again, within its delay (P812, P815, P883). Words that could enable a drive, as bits 0 to 2
        are those of an enabling control word, go only to one that monitors them within 0.5 s; else it is an UnmonitoredError."""
        if not 1 <= len(words) <= 3:
            raise ValueError(f"a telegram has one to three process data words, not {len(words)}")
        for word in words:
            if isinstance(word, bool) or not isinstance(word, int):
                raise TypeError(f"a process data word is a whole number, not {type(word).__name__}")
            if not 0 <= word <= 0xFFFF:
                raise ValueError(f"{word} is no word: 0 to 65535, a negative speed as 65536 + it")
        if any(word & 7 == 6 for word in words):
            self._refuse_unmonitored()
        answer = self.line.exchange_words(self.address, b"".join(word.to_bytes(2, "big") for word in words))
        if answer is None:
            raise NoAnswerError(f"unit {self.address} does not answer")
        return tuple(int.from_bytes(answer[2 * n : 2 * n + 2], "big") for n in range(len(words)))

    # Asked for again after a second: words come more often than that, and somebody else may have switched it off.
    def _refuse_unmonitored(self) -> None:
        if time.monotonic() < self._monitored_until:
            return
        for own in self._monitorings():
            trouble = None
            if not 0 < self.execute(READ, own.delay) <= LONGEST_SILENCE:
                trouble = (
                    f"{own.delay_name} is off or longer than {LONGEST_SILENCE} ms. Switch it on first: "
                    f"drive.write({own.delay}, {LONGEST_SILENCE})"
                )
            elif self._read_if_there(own.response) in (0, 1):  # None: it cannot be chosen, the unit stops
                trouble = f"{own.response_name} lets it go on. Choose a stop first: drive.write({own.response}, 4)"
            if trouble:
                raise UnmonitoredError(
                    f"these process data could enable unit {self.address}, and it does not monitor them, so it would move on "
                    f"when nobody sends any more: {trouble}"
                )
        self._monitored_until = time.monotonic() + 1

    # Of the lines over which the drive has this address; of all where it tells none.
    def _monitorings(self) -> list[Monitoring]:
        own = [(each, each.address and self._read_if_there(each.address)) for each in self.line.monitoring]
        here = [each for each, address in own if address == self.address]
        return here or [each for each, address in own if address is not None or each is self.line.monitoring[0]]

    def _read_if_there(self, index: int) -> Optional[int]:
        try:
            return self.execute(READ, index)
        except DriveRefusedError:
            return None

    @property
    def status_word(self) -> int:
        return self.execute(READ, _STATUS) & 0xFFFF

    @property
    def fault(self) -> int:
        """Number of the pending fault; 0 is none (status word 1 with bit 5, 1053 1610 p. 41)."""
        word = self.status_word
        return word >> 8 if word & 0x20 else 0

    def watch(self, *names: str | int, every: float = 0.1, sleep: Callable[[float], Any] = time.sleep) -> Iterator[tuple]:
        """Values of parameters and variables again and again, for ever. On a plant `sleep` lets virtual time pass."""
        while True:
            yield tuple(self[name] for name in names)
            sleep(every)


def scan(line: Line, addresses: Optional[range] = None) -> list[Drive]:
    """The drives that answer, in the order of their addresses."""
    found = []
    for address in addresses or line.addresses:
        request = bytes([_FOUR_BYTES | READ, 0]) + _FIRMWARE.to_bytes(2, "big") + bytes(4)
        if line.exchange(address, request) is not None:
            found.append(Drive(line, address))
    return found
