"""Plants of IPOSplus drives in Python.

    import ipos

    with ipos.Plant("line.toml") as plant:
        plant.run("1s")
        print(plant["saw"]["lCount"])
"""

from ._library import ClosedError, Mistake, PlantError, QueueFullError, RefusedError, ThreadError, version
from .bus import Bus, Frame, Telegram
from .fms import Fms, FmsError
from .plant import JournalEntry, Plant
from .station import AnalogValue, ParameterValue, Station

__version__ = "0.1.0"
__all__ = [
    "AnalogValue",
    "Bus",
    "ClosedError",
    "Fms",
    "FmsError",
    "Frame",
    "JournalEntry",
    "Mistake",
    "ParameterValue",
    "Plant",
    "PlantError",
    "QueueFullError",
    "RefusedError",
    "Station",
    "Telegram",
    "ThreadError",
    "version",
]
