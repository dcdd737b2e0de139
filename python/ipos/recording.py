"""Many signals in one call, and their course over time."""

from __future__ import annotations

import os
from ctypes import c_int64, c_uint32
from struct import Struct
from typing import TYPE_CHECKING, Sequence

from . import _library as lib

if TYPE_CHECKING:
    from .plant import Plant


class Reader:
    """Reads signals of any stations in one call of the library. Values are numbers as people read them."""

    def __init__(self, plant: "Plant", names: Sequence[str]) -> None:
        if isinstance(names, str):
            raise TypeError("signals are several names, not one text")
        self._plant = plant
        self.names = tuple(names)
        signals, self._factors, units = [], [], []
        for name in self.names:
            owner, rest = plant._signal_of(name)
            signal = owner._find(lib.ANY, rest)
            scale = owner._scale(signal)
            signals.append(signal)
            self._factors.append(scale.factor)
            units.append(scale.unit)
        self.units = tuple(units)
        self._plain = all(factor == 1 for factor in self._factors)
        self._signals = (c_uint32 * len(signals))(*signals)
        self._values = (c_int64 * len(signals))()
        self._unpack = Struct(f"{len(signals)}q").unpack  # seven times as fast as tuple(self._values)

    def __call__(self) -> tuple[float, ...]:
        self._plant._call("read_many", self._signals, len(self._signals), self._values)
        if self._plain:
            return self._unpack(self._values)
        return tuple(
            value if factor == 1 else value * factor for value, factor in zip(self._unpack(self._values), self._factors)
        )

    def __repr__(self) -> str:
        return f"<Reader of {', '.join(self.names)}>"


class Recording:
    """Signals over time: `times` in seconds, recording["saw.speed"] a list of numbers. plot() needs matplotlib, to_pandas() pandas."""

    def __init__(self, plant: "Plant", names: Sequence[str], duration: int, every: int) -> None:
        read = self._begin(plant, names, every)
        now = plant._now()
        end = now + duration
        while True:
            self._take(now, read())
            if now + every > end:
                break
            now += every
            plant._run_to(now)
        plant._run_to(end)

    @classmethod
    def of_replay(cls, plant: "Plant", names: Sequence[str], every: int) -> "Recording":
        """The run of a plant from its beginning; times are full milliseconds."""
        recording = cls.__new__(cls)
        read = recording._begin(plant, names, every)
        failures: list[BaseException] = []

        @lib.CONDITION
        def look(_user: object, _plant: object) -> bool:
            try:
                now = plant._now()
                if not failures and now % every == 0:
                    recording._take(now, read())
            except BaseException as failure:  # must not leave through C
                failures.append(failure)
            return False

        plant._call("replay", look, None)
        if failures:
            raise failures[0]
        return recording

    def _begin(self, plant: "Plant", names: Sequence[str], every: int) -> Reader:
        if every <= 0:
            raise ValueError("signals are read every so often: every is more than 0")
        read = Reader(plant, names)
        self.names, self.units = read.names, read.units
        self.times: list[float] = []
        self._columns: list[list[float]] = [[] for _ in self.names]
        return read

    def _take(self, now: int, values: Sequence[float]) -> None:
        self.times.append(now / 1e9)
        for column, value in zip(self._columns, values):
            column.append(value)

    def write_csv(self, path: "str | os.PathLike[str]") -> None:
        """One row a sample: time in seconds, then the signals."""
        with open(os.fspath(path), "w", encoding="utf-8") as out:  # a number would be a file descriptor
            heads = [f"{name} [{unit}]" if unit else name for name, unit in zip(self.names, self.units)]
            out.write(",".join(["time [s]", *heads]) + "\n")
            for row in zip(self.times, *self._columns):
                out.write(",".join(f"{value:.9g}" for value in row) + "\n")

    def __getitem__(self, name: str) -> list[float]:
        if name not in self.names:
            raise lib.unknown(f"'{name}' was not recorded; there are {', '.join(self.names)}")
        return self._columns[self.names.index(name)]

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"<Recording of {', '.join(self.names)}: {len(self)} samples>"

    def to_pandas(self) -> object:
        """A pandas.DataFrame: a column a signal, the times in seconds as its index, units in `attrs["units"]`."""
        try:
            import pandas
        except ImportError:
            raise ImportError("to_pandas() needs pandas; the numbers are in recording.times and recording[name]") from None
        index = pandas.Index(self.times, name="time [s]")
        frame = pandas.DataFrame(dict(zip(self.names, self._columns)), index=index)
        frame.attrs["units"] = dict(zip(self.names, self.units))
        return frame

    def plot(self, axes: object = None) -> object:
        """Draws one strip a unit with matplotlib and returns the axes; a notebook shows them."""
        try:
            from matplotlib import pyplot
        except ImportError:
            raise ImportError("plot() needs matplotlib; the numbers are in recording.times and recording[name]") from None
        units = list(dict.fromkeys(self.units))
        if axes is None:
            _, axes = pyplot.subplots(len(units), 1, sharex=True, squeeze=False)
            axes = list(axes[:, 0])  # type: ignore[index]
        for name, unit, column in zip(self.names, self.units, self._columns):
            strip = axes[units.index(unit) % len(axes)]  # type: ignore[index, arg-type]
            strip.step(self.times, column, where="post", label=name)
            strip.set_ylabel(unit)
            strip.legend(loc="best")
        axes[-1].set_xlabel("s")  # type: ignore[index]
        return axes
