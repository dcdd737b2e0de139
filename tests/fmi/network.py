"""A master for FMUs with terminals of FMI-LS-BUS: event mode, triggered clocks and countdowns, as importers for buses have it."""

import ctypes
import xml.etree.ElementTree as ElementTree

SOON = 1e-12  # s: two times that differ by the rounding of sums


class Terminal:
    """A terminal of an instance. A countdown is known by its variable, an output clock is triggered."""

    def __init__(self, instance, name):
        self.instance, self.name, self.due = instance, name, None
        root = ElementTree.parse(instance.fmu.folder / "terminalsAndIcons/terminalsAndIcons.xml").getroot()
        element, = [each for each in root.iter("Terminal") if each.get("name") == name]
        names = {each.get("memberName"): each.get("variableName") for each in element.iter("TerminalMemberVariable")}
        self.members = {member: instance.fmu.variables[variable] for member, variable in names.items()}
        self.is_countdown = self.members["Tx_Clock"].causality == "input"

    def _reference(self, member):
        return ctypes.byref(ctypes.c_uint(self.members[member].reference))

    def _set_clock(self, member):
        self.instance.call("SetClock", self._reference(member), ctypes.c_size_t(1), ctypes.byref(ctypes.c_bool(True)))

    def is_active(self, now):
        if self.is_countdown:
            active = self.due is not None and self.due <= now + SOON
            if active:
                self._set_clock("Tx_Clock")
            return active
        active = ctypes.c_bool(False)
        self.instance.call("GetClock", self._reference("Tx_Clock"), ctypes.c_size_t(1), ctypes.byref(active))
        return active.value

    def fetch(self):
        size, data = ctypes.c_size_t(), ctypes.c_void_p()
        self.instance.call("GetBinary", self._reference("Tx_Data"), ctypes.c_size_t(1), ctypes.byref(size), ctypes.byref(data), ctypes.c_size_t(1))
        self.due = None
        return ctypes.string_at(data, size.value) if size.value else b""

    def give(self, data, now):
        held = ctypes.c_char_p(data)
        self._set_clock("Rx_Clock")
        self.instance.call("SetBinary", self._reference("Rx_Data"), ctypes.c_size_t(1), ctypes.byref(ctypes.c_size_t(len(data))), ctypes.byref(held),
                           ctypes.c_size_t(1))

    def look(self, now):
        """What the FMU knows of its countdown."""
        if not self.is_countdown:
            return
        seconds, known = ctypes.c_double(), ctypes.c_int()
        self.instance.call("GetIntervalDecimal", self._reference("Tx_Clock"), ctypes.c_size_t(1), ctypes.byref(seconds), ctypes.byref(known))
        if known.value == 2:
            self.due = now + seconds.value


class Ear:
    """A node without an FMU: what comes is kept with its time, and `say` is sent."""

    def __init__(self):
        self.heard, self.said, self.is_countdown, self.due, self.instance = [], b"", False, None, None

    def say(self, data):
        self.said += data

    def is_active(self, now):
        return self.said != b""

    def fetch(self):
        data, self.said = self.said, b""
        return data

    def give(self, data, now):
        self.heard.append((now, data))

    def look(self, now):
        pass


class Network:
    """Pairs of terminals that are connected. Instances are ready for initialization."""

    def __init__(self, *pairs):
        self.peers = {terminal: other for pair in pairs for terminal, other in (pair, pair[::-1])}
        self.terminals = list(self.peers)
        self.instances = list({id(each.instance): each.instance for each in self.terminals if each.instance is not None}.values())
        self.time = 0.0
        for instance in self.instances:
            instance.begin()
        self._events()

    def _events(self):
        for _ in range(100):
            moved = False
            # A bus takes what its nodes have sent, and all its clocks, before it is asked for what it sends.
            for is_countdown in (False, True):
                for terminal in [each for each in self.terminals if each.is_countdown == is_countdown and each.is_active(self.time)]:
                    if data := terminal.fetch():
                        self.peers[terminal].give(data, self.time)
                        moved = True
            for instance in self.instances:
                flags, then = (ctypes.c_bool * 5)(), ctypes.c_double()
                instance.call("UpdateDiscreteStates", *(ctypes.byref(flags, n) for n in range(5)), ctypes.byref(then))
            for terminal in self.terminals:
                terminal.look(self.time)
            if not moved and not any(each.due is not None and each.due <= self.time + SOON for each in self.terminals):
                break
        else:
            raise AssertionError(f"no end of events at {self.time} s")
        for instance in self.instances:
            instance.call("EnterStepMode")

    def run(self, until, grid=1e-3):
        """Steps end on the grid and where a countdown is over."""
        while self.time < until - SOON:
            times = [(round(self.time / grid - 1e-6) // 1 + 1) * grid, until, *(each.due for each in self.terminals if each.due is not None)]
            then = min(each for each in times if each > self.time + SOON)
            for instance in self.instances:
                instance.step(then - self.time)
                instance.time = then
                instance.call("EnterEventMode")
            self.time = then
            self._events()
