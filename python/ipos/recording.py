"""Many signals in one call, and their course over time."""

from __future__ import annotations

from ctypes import c_int64, c_uint32
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
            station, rest = plant._signal_of(name)
            signal = station._find(lib.ANY, rest)
            info = station._info(signal)
            signals.append(signal)
            self._factors.append(info.factor)
            units.append(lib.text(info.unit))
        self.units = tuple(units)
        self._plain = all(factor == 1 for factor in self._factors)
        self._signals = (c_uint32 * len(signals))(*signals)
        self._values = (c_int64 * len(signals))()

    def __call__(self) -> tuple[float, ...]:
        self._plant._call("read_many", self._signals, len(self._signals), self._values)
        if self._plain:
            return tuple(self._values)
        return tuple(
            value if factor == 1 else value * factor for value, factor in zip(self._values, self._factors)
        )

    def __repr__(self) -> str:
        return f"<Reader of {', '.join(self.names)}>"


class Recording:
    """Signals over time: `times` in seconds, recording["saw.speed"] a list of numbers. plot() needs matplotlib."""

    def __init__(self, plant: "Plant", names: Sequence[str], duration: int, every: int) -> None:
        if every <= 0:
            raise ValueError("signals are read every so often: every is more than 0")
        read = Reader(plant, names)
        self.names, self.units = read.names, read.units
        self.times: list[float] = []
        self._columns: list[list[float]] = [[] for _ in self.names]
        now = plant._now()
        end = now + duration
        while True:
            self.times.append(now / 1e9)
            for column, value in zip(self._columns, read()):
                column.append(value)
            if now + every > end:
                break
            now += every
            plant._run_to(now)
        plant._run_to(end)

    def __getitem__(self, name: str) -> list[float]:
        if name not in self.names:
            raise lib._KeyError(f"'{name}' was not recorded; there are {', '.join(self.names)}")
        return self._columns[self.names.index(name)]

    def __len__(self) -> int:
        return len(self.times)

    def __repr__(self) -> str:
        return f"<Recording of {', '.join(self.names)}: {len(self)} samples>"

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
