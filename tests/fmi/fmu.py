"""A small importer of FMUs for co-simulation: unpacked, loaded and called by ctypes, as other simulators do it in C."""

import ctypes
import os
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
import zipfile
from pathlib import Path

IPOS = os.environ["IPOS"]
SOURCE = Path(os.environ["IPOS_SOURCE"])
LOGGER2 = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
LOGGER3 = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p, ctypes.c_char_p)
TYPES = {"Real": (ctypes.c_double, "Real", "Float64"), "Float64": (ctypes.c_double, "Real", "Float64"),
         "Integer": (ctypes.c_int, "Integer", "Int32"), "Int32": (ctypes.c_int32, "Integer", "Int32"),
         "Boolean": (ctypes.c_int, "Boolean", "Boolean"), "Enumeration": (ctypes.c_int, "Integer", "Int64")}


def ipos(*arguments, **more):
    return subprocess.run([IPOS, *map(str, arguments)], capture_output=True, text=True, timeout=60, **more)


def write_fmu(plant, out, version, *more):
    done = ipos("fmu", plant, "-o", out, "--fmi", version, *more)
    assert done.returncode == 0, done.stderr
    return out


class Callbacks(ctypes.Structure):
    _fields_ = [("logger", LOGGER2), ("allocate", ctypes.c_void_p), ("free", ctypes.c_void_p), ("finished", ctypes.c_void_p),
                ("environment", ctypes.c_void_p)]


class Variable:
    def __init__(self, element, kind):
        self.reference = int(element.get("valueReference"))
        self.causality = element.get("causality")
        self.start = kind.get("start")
        self.unit = kind.get("unit")
        self.kind = kind.tag


class Fmu:
    """An unpacked FMU; several instances may be made of it."""

    def __init__(self, path, folder):
        with zipfile.ZipFile(path) as archive:
            archive.extractall(folder)
        self.folder = Path(folder)
        root = ElementTree.parse(self.folder / "modelDescription.xml").getroot()
        self.version = int(root.get("fmiVersion")[0])
        self.token = root.get("guid") or root.get("instantiationToken")
        name = root.find("CoSimulation").get("modelIdentifier") + ".so"
        platform = "linux64" if self.version == 2 else "x86_64-linux"
        self.library = ctypes.CDLL(str(self.folder / "binaries" / platform / name))
        self.variables = {}
        for element in root.find("ModelVariables"):
            kind = element[0] if self.version == 2 else element
            self.variables[element.get("name")] = Variable(element, kind)

    def make(self, events=False):
        return Instance(self, events)


class Instance:
    def __init__(self, fmu, events=False):
        self.events = events
        self.fmu, self.version, self.library, self.told = fmu, fmu.version, fmu.library, []
        resources = fmu.folder / "resources"
        make = getattr(self.library, "fmi2Instantiate" if self.version == 2 else "fmi3InstantiateCoSimulation")
        make.restype = ctypes.c_void_p
        if self.version == 2:
            self._logger = LOGGER2(lambda environment, name, status, category, text: self.told.append(text.decode()))
            self._callbacks = Callbacks(self._logger, None, None, None, None)
            made = make(b"one", 1, fmu.token.encode(), resources.as_uri().encode(), ctypes.byref(self._callbacks), 0, 0)
        else:
            self._logger = LOGGER3(lambda environment, status, category, text: self.told.append(text.decode()))
            made = make(b"one", fmu.token.encode(), (str(resources) + "/").encode(), False, True, events, False, None,
                        ctypes.c_size_t(0), None, self._logger, None)
        assert made, self.told
        self.component = ctypes.c_void_p(made)
        self.time = 0.0

    def call(self, name, *arguments):
        status = getattr(self.library, f"fmi{self.version}{name}")(self.component, *arguments)
        assert status == 0, (name, status, self.told)

    def begin(self):
        if self.version == 2:
            self.call("SetupExperiment", 0, ctypes.c_double(0), ctypes.c_double(0), 0, ctypes.c_double(0))
            self.call("EnterInitializationMode")
        else:
            self.call("EnterInitializationMode", False, ctypes.c_double(0), ctypes.c_double(0), False, ctypes.c_double(0))
        self.call("ExitInitializationMode")
        return self

    def _values(self, how, variable, value):
        kind, two, three = TYPES[variable.kind]
        if self.version == 3 and variable.kind == "Boolean":
            kind = ctypes.c_bool
        if self.version == 3 and variable.kind == "Enumeration":
            kind = ctypes.c_int64
        reference, held = ctypes.c_uint(variable.reference), kind(value)
        more = () if self.version == 2 else (ctypes.c_size_t(1),)
        self.call(how + (two if self.version == 2 else three), ctypes.byref(reference), ctypes.c_size_t(1), ctypes.byref(held), *more)
        return held.value

    def get(self, name):
        return self._values("Get", self.fmu.variables[name], 0)

    def set(self, name, value):
        self._values("Set", self.fmu.variables[name], value)

    def step(self, length):
        """True: the FMU asks for event mode."""
        until, flags = self.time + length, (ctypes.c_bool * 3)()
        if self.version == 2:
            self.call("DoStep", ctypes.c_double(self.time), ctypes.c_double(length), 1)
        else:
            reached = ctypes.c_double()
            places = [ctypes.byref(flags, n) for n in range(3)]
            self.call("DoStep", ctypes.c_double(self.time), ctypes.c_double(length), True, *places, ctypes.byref(reached))
        self.time = until
        return flags[0]

    def state(self):
        state = ctypes.c_void_p()
        self.call("GetFMUstate" if self.version == 2 else "GetFMUState", ctypes.byref(state))
        return state

    def go_to(self, state, time):
        self.call("SetFMUstate" if self.version == 2 else "SetFMUState", state)
        self.time = time

    def forget(self, state):
        self.call("FreeFMUstate" if self.version == 2 else "FreeFMUState", ctypes.byref(state))

    def free(self):
        getattr(self.library, f"fmi{self.version}FreeInstance")(self.component)


def trace(plant, seconds, signals, folder):
    """Rows of ipos run --trace as texts: a dict of name to value for each millisecond from 1 on."""
    out = Path(folder) / "trace.csv"
    done = ipos("run", plant, "--for", f"{seconds}s", "--trace", out, "--signals", ",".join(signals))
    assert done.returncode in (0, 1), done.stderr
    lines = out.read_text().splitlines()
    head = [cell.split(" [")[0].split(" (")[0] for cell in lines[0].split(",")]
    return [dict(zip(head, line.split(","))) for line in lines[1:]]


def as_shown(value, like):
    """A number with the digits of a text."""
    digits = len(like.partition(".")[2])
    text = f"{float(value):.{digits}f}"
    return text[1:] if float(text) == 0 and text.startswith("-") else text


if __name__ == "__main__":
    sys.exit("this is for the tests beside it")
