"""A plant: stations and buses on one virtual clock."""

from __future__ import annotations

import os
import threading
from ctypes import byref, c_char_p, c_int64, c_size_t, c_uint64, c_void_p, create_string_buffer
from typing import Callable, Iterator, Mapping, NamedTuple, Sequence

from . import _library as lib
from ._signals import SignalOwner
from .bus import Bus
from .recording import Reader, Recording
from .station import Station

_CHUNK = 1_000_000_000  # ns of virtual time in one call of the library, so that Ctrl-C is heard
_MILLISECOND = 1_000_000

_WEIGHTS = ("why", "warning", "fault")


class JournalEntry(NamedTuple):
    """What a user has to be told about a run. `weight` is "why", "warning" or "fault"; station "" is the plant."""

    time: float
    weight: str
    station: str
    text: str

    def __str__(self) -> str:
        who = f"{self.station}: " if self.station else ""
        return f"{self.time * 1e3:.3f} ms {who}{self.weight}: {self.text}"


class _Buses(lib.Named):
    """Buses by name."""

    def __init__(self, plant: "Plant", buses: Mapping[str, Bus]) -> None:
        self._plant, self._buses = plant, buses

    def __getitem__(self, name: str) -> Bus:
        if name not in self._buses:
            known = ", ".join(self._buses) or "none"
            raise lib.unknown(f"there is no bus '{name}'; the plant has {known}")
        return self._buses[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._buses)

    def __len__(self) -> int:
        return len(self._buses)

    def __repr__(self) -> str:
        return f"<buses {', '.join(self._buses) or 'none'}>"


class _Gate:
    """The way into the library: nobody ends a plant while a thread is inside, or reads a text that it has handed out."""

    def __init__(self, handle: c_void_p | None) -> None:
        self.handle = handle
        self._inside = 0
        self._lock = threading.Lock()

    def __enter__(self) -> c_void_p:
        with self._lock:
            if self.handle is None:
                raise lib.ClosedError("the plant is closed")
            self._inside += 1
            return self.handle

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._inside -= 1

    def shut(self) -> c_void_p | None:
        """Takes the handle away from all; nothing if somebody has done so."""
        with self._lock:
            if self._inside:
                raise lib.ThreadError("the plant cannot be closed while a call of it is under way")
            handle, self.handle = self.handle, None
            return handle


class Plant(lib.Named):
    """Opens a plant file (or a program, which makes a plant of one station), or the text of one.

    folder       where programs are, with `text`; else that of the file
    include_dirs, defines   for the compiler; defines as a mapping or as "NAME=TEXT"
    speed        commands per ms of every task in place of P938 and P939
    seed         added to the seeds of the plant's faults
    write_memory nvram files are written, as `ipos run` does; such a plant keeps no record
    record       False: what is done to the plant is not recorded; no snapshots and no trace hash then
    """

    _gate = _Gate(None)  # of a plant that was never opened

    def __init__(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        text: str | None = None,
        folder: str | os.PathLike[str] | None = None,
        include_dirs: Sequence[str | os.PathLike[str]] = (),
        defines: Mapping[str, object] | Sequence[str] = (),
        speed: int = 0,
        seed: int = 0,
        write_memory: bool = False,
        record: bool = True,
    ) -> None:
        if path is None and text is None:
            raise TypeError("a plant is opened from a path or from text=...")
        if isinstance(defines, Mapping):
            defines = [f"{name}={value}" for name, value in defines.items()]
        self._path = os.fspath(path) if path is not None else None
        self.recorded = record and not write_memory
        source = lib.Source()
        source.path = None if path is None else lib.encoded(self._path, is_path=True)
        source.text = None if text is None else lib.encoded(text)
        source.folder = None if folder is None else lib.encoded(os.fspath(folder), is_path=True)
        folders = [lib.encoded(os.fspath(each), is_path=True) for each in include_dirs]
        source.include_dirs, source.include_dir_count = _array(folders)
        source.defines, source.define_count = _array([lib.encoded(each) for each in defines])
        source.flags = (lib.WRITE_MEMORY if write_memory else 0) | (0 if record else lib.NO_RECORD)
        source.commands_a_ms = _in_range("speed", speed, 1_000_000)
        source.seed = _in_range("seed", seed, 2**64 - 1)
        handle = c_void_p()
        status = lib.function("open")(byref(source), byref(handle))
        if status == lib.OK:
            self._gate = _Gate(handle)
            self._find_members()
        else:
            self._fail_to_open(status, handle)

    def _fail_to_open(self, status: int, handle: c_void_p) -> None:
        if not handle:
            raise lib.error_of(status, "")
        errors = []
        row = lib.MistakeRow()
        for number in range(lib.function("mistakes")(handle)):
            lib.function("mistake_at")(handle, number, byref(row))
            errors.append(lib.Mistake(lib.text(row.file), row.line, row.column, lib.text(row.text)))
        lib.function("close")(handle)
        raise lib.PlantError("\n".join(map(str, errors)) or lib.status_text(status), errors)

    def _find_members(self) -> None:
        self._stations: dict[str, Station] = {}
        info = lib.StationInfo()
        while lib.function("station_at")(self._gate.handle, len(self._stations), byref(info)) == lib.OK:
            name = lib.text(info.name)
            self._stations[name] = Station(self, len(self._stations), info)
        buses: dict[str, Bus] = {}
        row = lib.BusInfo()
        while lib.function("bus_at")(self._gate.handle, len(buses), byref(row)) == lib.OK:
            buses[lib.text(row.name)] = Bus(self, len(buses), row)
        self._buses = _Buses(self, buses)

    # --- the library

    @property
    def _closed(self) -> bool:
        return self._gate.handle is None

    def _call(self, name: str, *arguments: object) -> None:
        with self._gate as handle:
            status = lib.function(name)(handle, *arguments)
            if status != lib.OK:
                raise self._error(status)

    def _text(self, name: str, *arguments: object) -> str:
        """The text a function hands out: the library keeps it until the next call."""
        text = c_char_p()
        with self._gate:
            self._call(name, *arguments, byref(text))
            return lib.text(text.value)

    def _error(self, status: int) -> Exception:
        with self._gate as handle:
            return lib.error_of(status, lib.text(lib.function("message")(handle)))

    def close(self) -> None:
        """Ends the plant; what it was asked to keep is stored. Closing twice is allowed."""
        handle = self._gate.shut()
        if handle is not None and lib.function("close")(handle) != lib.OK:
            raise lib.PlantError("a memory file could not be written")

    def adopt(self) -> None:
        """From now on the plant belongs to the calling thread."""
        self._call("adopt")

    def __enter__(self) -> "Plant":
        with self._gate:
            return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __del__(self) -> None:
        try:
            self.close()
        except Exception:  # at the end of the interpreter anything may be gone
            pass

    def __reduce__(self):
        raise TypeError("a plant cannot be pickled; its snapshot() can")

    def __repr__(self) -> str:
        what = self._path or "of a text"
        if self._closed:
            return f"<Plant {what}, closed>"
        return f"<Plant {what} at {self.time:.3f} s: {', '.join(self._stations)}>"

    # --- time

    @property
    def time_us(self) -> int:
        """Virtual time since power-on in microseconds."""
        return self._now() // 1000

    @property
    def time(self) -> float:
        """Virtual time since power-on in seconds."""
        return self._now() / 1e9

    def _now(self) -> int:
        now = c_int64()
        self._call("time", byref(now))
        return now.value

    def run(
        self,
        duration: str | float | None = None,
        *,
        until: Callable[[], object] | None = None,
        limit: str | float = "60s",
    ) -> bool:
        """Lets virtual time pass: "1s", "20ms", or a number of seconds.

        With `until` as long as it is false, at most until `limit` has passed: it is asked now and at every millisecond.
        True, or with `until` whether it came true.
        """
        if until is None:
            if duration is None:
                raise TypeError("run() needs a duration or until=...")
            self._run_to(self._now() + lib.duration_ns(duration))
            return True
        if duration is not None:
            raise TypeError("run() takes a duration, or until=... with limit=...")
        if not callable(until):
            raise TypeError(f"until is a function that is asked every millisecond, not {type(until).__name__}")
        now = self._now()
        end = now + lib.duration_ns(limit)
        while not until():
            if now >= end:
                return False
            now = min((now // _MILLISECOND + 1) * _MILLISECOND, end)
            self._call("run", now)
        return True

    def _run_to(self, end: int) -> None:
        if end >= 2**63 - 1:
            raise ValueError("that is beyond the end of virtual time")
        now = self._now()
        while now < end:
            now = min(now + _CHUNK, end)
            self._call("run", now)

    def _run_to_frame(self, bus: int, end: int) -> None:
        self._call("run_to_frame", bus, end)

    # --- what is in it

    def __getitem__(self, name: str) -> Station:
        with self._gate:
            if name not in self._stations:
                raise lib.unknown(f"there is no station '{name}'; the plant has {', '.join(self._stations)}")
            return self._stations[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._stations)

    def __len__(self) -> int:
        return len(self._stations)

    def __contains__(self, name: object) -> bool:
        return name in self._stations

    @property
    def stations(self) -> Mapping[str, Station]:
        """The stations by name, in the order of the file."""
        return dict(self._stations)

    @property
    def buses(self) -> Mapping[str, Bus]:
        """The buses by name."""
        with self._gate:
            return self._buses

    @property
    def journal(self) -> list[JournalEntry]:
        """What there is to tell so far."""
        entries = []
        row = lib.Entry()
        with self._gate as handle:
            while lib.function("journal_at")(handle, len(entries), byref(row)) == lib.OK:
                entries.append(
                    JournalEntry(row.time / 1e9, _WEIGHTS[row.weight], lib.text(row.station), lib.text(row.text))
                )
        if not entries:
            self._now()  # says why it cannot be read
        return entries

    def reader(self, *names: str) -> Reader:
        """Reads many signals in one call: plant.reader("saw.lCount", "saw.speed")() is a tuple of their values."""
        return Reader(self, names)

    def record(self, names: Sequence[str], duration: str | float, every: str | float = "1ms") -> Recording:
        """Runs so long and reads the signals meanwhile; see Recording."""
        return Recording(self, names, lib.duration_ns(duration), lib.duration_ns(every))

    def replay(self, names: Sequence[str], every: str | float = "1ms") -> Recording:
        """The signals from power-on until now, though nobody has recorded them: the run is done once more for it."""
        return Recording.of_replay(self, names, lib.duration_ns(every))

    def _signal_of(self, name: str) -> tuple[SignalOwner, str]:
        """ "saw.lCount": the station or line with the longest fitting name, and the rest."""
        if not isinstance(name, str):
            raise TypeError(f"a signal is named by a text such as 'saw.lCount', not {type(name).__name__}")
        owners: dict[str, SignalOwner] = {**self._buses, **self._stations}
        fits = [each for each in owners if name.startswith(each + ".")]
        if not fits:
            known = ", ".join(each + "." for each in [*self._stations, *self._buses])
            raise lib.unknown(f"'{name}' is no signal; signals begin with {known}")
        owner = max(fits, key=len)
        return owners[owner], name[len(owner) + 1 :]

    # --- faults of lines

    def plant_fault(self, bus: str, kind: str, **keys: object) -> None:
        """Plants a fault of a line, with the keys of [[fault]] in a plant file; its times count from now.

        plant.plant_fault("sbus", "drop", id=0x40B, rate=100)
        """
        rows = [f"{key.rstrip('_')} = {_toml(value)}" for key, value in {"bus": bus, "kind": kind, **keys}.items()]
        self._call("line_fault", lib.encoded("[[fault]]\n" + "\n".join(rows) + "\n"))

    # --- state

    @property
    def trace_hash(self) -> str:
        """One number over everything that happened so far, as `ipos run --trace-hash` prints it."""
        value = c_uint64()
        self._call("trace_hash", byref(value))
        return f"{value.value:016x}"

    def snapshot(self) -> bytes:
        """The whole state; restore() takes it in any plant of the same contents, also in another process."""
        size = c_size_t(0)
        with self._gate as handle:
            status = lib.function("save")(handle, None, byref(size))
            if status != lib.TOO_SMALL:
                raise self._error(status)
        room = create_string_buffer(size.value)
        self._call("save", room, byref(size))
        return room.raw[: size.value]

    def restart(self) -> None:
        """At time 0 again, as it was opened, without reading or compiling anything; what was done to it is forgotten.

        for load in range(100):
            plant.restart()
            plant["saw"]["lLoad"] = load
            plant.run("500ms")
        """
        self._call("restart")

    def restore(self, snapshot: bytes) -> None:
        """Back to a snapshot, or forth. Takes the time the run took from its beginning."""
        if not isinstance(snapshot, (bytes, bytearray, memoryview)):
            raise TypeError(f"a snapshot is bytes, not {type(snapshot).__name__}")
        self._call("restore", bytes(snapshot), len(snapshot))


def _array(texts: Sequence[bytes]) -> tuple[object, int]:
    return (c_char_p * len(texts))(*texts), len(texts)


def _in_range(what: str, value: int, most: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise TypeError(f"{what} is a whole number, not {type(value).__name__}")
    if not 0 <= value <= most:
        raise ValueError(f"{what} is 0 to {most}")
    return value


def _toml(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, str):
        return '"' + value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    raise TypeError(f"a fault has texts and whole numbers, not {type(value).__name__}")
