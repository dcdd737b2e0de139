"""The python-can backend `ipos`: whatever is written for python-can runs on the CAN line of a plant.

    bus = can.Bus(interface="ipos", channel="line.toml#sbus")

Lockstep (the default): virtual time stands until recv() moves it, to the next frame or by the timeout, and recv() returns
at once. send() moves it only where 64 frames wait already, until there is room. The same calls see the same frames at the
same times. One thread.

realtime=True: a thread runs the plant in step with the clock; send() and recv() may come from any thread, so Notifiers
and masters with threads of their own work. A Notifier on a lockstep bus would run virtual time away.

Buses of one process with the same channel are stations on the same line of the same plant.
"""

from __future__ import annotations

import os
import queue
import threading
import time
from typing import Any, Callable, Optional, Sequence, TypeVar, Union

import can
from can.broadcastmanager import (
    CyclicSendTaskABC,
    LimitedDurationCyclicSendTaskABC,
    ModifiableCyclicTaskABC,
    RestartableCyclicTaskABC,
)

from ._library import CONTROLLER, PASSIVE, PlantError, QueueFullError
from .bus import Frame
from .plant import Plant

_FOR_EVER_NS = 1_000_000_000  # recv() without timeout looks for signals this often in virtual time
_POLL = 0.001  # s of the clock between two steps of a plant in real time

Result = TypeVar("Result")


class _Line:
    """A line of an open plant and the buses on it."""

    open_lines: dict[tuple[str, str, bool], "_Line"] = {}
    lock = threading.Lock()

    def __init__(self, key: object, plant: Plant, name: str, owned: bool) -> None:
        self.key, self.plant, self.name, self.owned = key, plant, name, owned
        self.bus = plant.buses[name]
        if self.bus.kind != "can":
            raise can.CanInitializationError(f"'{name}' is a serial line, not a CAN bus")
        self.members: list["IposBus"] = []
        self.bus.join()
        self.bus.frames(errors=True)

    def enter(self, member: "IposBus") -> None:
        self.members.append(member)

    def leave(self, member: "IposBus") -> None:
        with _Line.lock:
            if member in self.members:
                self.members.remove(member)
            if self.members:
                return
            _Line.open_lines.pop(self.key, None)  # type: ignore[arg-type]
            self.end()

    def end(self) -> None:
        if self.owned:
            self.plant.close()

    def queue(self, member: "IposBus", message: can.Message) -> bool:
        """False: 64 frames wait, and there is no room."""
        try:
            self._queue(member, message)
        except QueueFullError:
            return False
        return True

    def _queue(self, member: "IposBus", message: can.Message) -> None:
        tag = self.bus.send(
            message.arbitration_id,
            bytes(message.data or b""),
            extended=message.is_extended_id,
            remote=message.is_remote_frame,
            length=message.dlc if message.is_remote_frame else None,
        )
        member.sent.add(tag)

    def deliver(self) -> None:
        for frame in self.bus.frames(errors=True):
            for member in tuple(self.members):
                member.take(frame)

    # --- lockstep

    def send(self, member: "IposBus", message: can.Message, timeout: Optional[float]) -> bool:
        """Waits for room in virtual time; False: the timeout is over. None waits as long as it takes."""
        end = None if timeout is None else self.plant._now() + round(max(timeout, 0) * 1e9)
        while not self.run_to(self.plant._now() + _FOR_EVER_NS if end is None else end, lambda: self.queue(member, message)):
            if end is not None:
                return False
        return True

    def run_to(self, end: int, heard: Callable[[], bool]) -> bool:
        """Runs until `heard` is true or it is `end`; cyclic messages go out at their times."""
        while not heard():
            now = self.plant._now()
            if now >= end:
                return False
            due = [task.next for member in self.members for task in member.cyclic if task.running]
            self.plant._run_to_frame(self.bus._number, max(now, min([end, *due])))
            for member in tuple(self.members):
                for task in tuple(member.cyclic):
                    task.send_due(self.plant._now())
            self.deliver()
        return True

    def call(self, function: Callable[[Plant], Result]) -> Result:
        return function(self.plant)


class _RealTimeLine(_Line):
    """The same with a thread that runs the plant in step with the clock."""

    def __init__(self, key: object, plant: Plant, name: str, owned: bool) -> None:
        super().__init__(key, plant, name, owned)
        self._orders: "queue.SimpleQueue[Optional[Callable[[], None]]]" = queue.SimpleQueue()
        self.failure: Optional[Exception] = None
        self._thread = threading.Thread(target=self._run, name=f"ipos {name}", daemon=True)
        self._thread.start()

    def _run(self) -> None:
        try:
            self.plant.adopt()
            self._begin = time.monotonic_ns() - self.plant._now()
            while True:
                try:
                    order = self._orders.get(timeout=_POLL)
                    if order is None:
                        break
                    order()
                except queue.Empty:
                    pass
                self._follow()
        except Exception as error:  # whoever waits for frames hears why none comes
            self.failure = error
        for member in tuple(self.members):
            member.frames.put(None)

    def _follow(self) -> None:
        """The plant up to the clock; in its thread."""
        self.plant._run_to(time.monotonic_ns() - self._begin)
        self.deliver()

    def send(self, member: "IposBus", message: can.Message, timeout: Optional[float]) -> bool:
        """Waits for room by the clock."""
        end = None if timeout is None else time.monotonic() + timeout
        while not self.call(lambda _: self.queue(member, message)):
            if end is not None and time.monotonic() >= end:
                return False
            time.sleep(_POLL)
            if threading.current_thread() is self._thread:
                self._follow()
        return True

    def end(self) -> None:
        self._orders.put(None)
        if threading.current_thread() is not self._thread:
            self._thread.join()
        self.plant.adopt()
        super().end()

    def call(self, function: Callable[[Plant], Result]) -> Result:
        """function(plant) in the thread of the plant."""
        if threading.current_thread() is self._thread:
            return function(self.plant)
        answer: "queue.SimpleQueue[tuple[Any, Optional[Exception]]]" = queue.SimpleQueue()

        def order() -> None:
            try:
                answer.put((function(self.plant), None))
            except Exception as error:
                answer.put((None, error))

        self._orders.put(order)
        while True:
            try:
                result, error = answer.get(timeout=0.1)
            except queue.Empty:
                if not self._thread.is_alive():
                    raise can.CanOperationError(f"the plant has ended: {self.failure}") from self.failure
                continue
            if error is not None:
                raise error
            return result


class _Cyclic(LimitedDurationCyclicSendTaskABC, ModifiableCyclicTaskABC, RestartableCyclicTaskABC):
    """Messages of a lockstep bus that go out again and again in virtual time."""

    def __init__(
        self, bus: "IposBus", messages: Union[Sequence[can.Message], can.Message], period: float, duration: Optional[float]
    ) -> None:
        super().__init__(messages, period, duration)
        self.bus = bus
        self.step = max(1, round(period * 1e9))
        self.start()

    def start(self) -> None:
        self.next = self.bus.line.plant._now()
        self.end = None if self.duration is None else self.next + round(self.duration * 1e9)
        self.number = 0
        self.running = True
        if self not in self.bus.cyclic:
            self.bus.cyclic.append(self)

    def stop(self) -> None:
        self.running = False

    def send_due(self, now: int) -> None:
        while self.running and self.next <= now:
            if self.end is not None and self.next >= self.end:
                return self.stop()
            self.bus.send(self.messages[self.number % len(self.messages)], timeout=0)
            self.number += 1
            self.next += self.step


class IposBus(can.BusABC):
    """A station on a CAN line of a plant.

    channel   "line.toml#sbus"; without #... the only CAN bus of the plant
    plant     a Plant that is open, in place of the file; it stays open, and its time is moved by this bus, too
    realtime  in step with the clock, in a thread
    receive_own_messages   what is sent comes back when it has been on the line
    bitrate, timing        where given, they have to be those of the line
    """

    def __init__(
        self,
        channel: Any = None,
        can_filters: Any = None,
        *,
        plant: Optional[Plant] = None,
        realtime: Union[bool, str] = False,
        receive_own_messages: Union[bool, str] = False,
        **kwargs: Any,
    ) -> None:
        _refuse_fd(kwargs)
        self.realtime = _flag(realtime)
        self.receive_own_messages = _flag(receive_own_messages)
        self.frames: "queue.SimpleQueue[Optional[can.Message]]" = queue.SimpleQueue()
        self.sent: set[int] = set()
        self.cyclic: list[_Cyclic] = []
        self._state = can.BusState.ACTIVE
        self._closed = False
        try:
            self.line = self._line_of(channel, plant)
        except (PlantError, OSError, KeyError, ValueError) as error:
            raise can.CanInitializationError(str(error)) from error
        rate = getattr(kwargs.get("timing"), "bitrate", kwargs.get("bitrate"))
        if rate is not None and int(rate) != self.line.bus.baud:
            baud = self.line.bus.baud
            self.line.leave(self)
            raise can.CanInitializationError(f"bus '{self.line.name}' of the plant has {baud} bit/s, not {rate}")
        self.channel_info = f"ipos {self.line.name} of {self.line.plant._path or 'a plant'}"
        super().__init__(channel=channel, can_filters=can_filters, **kwargs)
        self.line.enter(self)

    def _line_of(self, channel: Any, plant: Optional[Plant]) -> _Line:
        path, _, name = str(channel or "").rpartition("#") if "#" in str(channel) else (str(channel or ""), "", "")
        if plant is not None:
            name = name or path
            key: tuple[str, str, bool] = (f"plant {id(plant)}", name, self.realtime)
        else:
            if not path:
                raise can.CanInitializationError('channel names plant and bus: "line.toml#sbus"')
            key = (os.path.realpath(path), name, self.realtime)
        with _Line.lock:
            line = _Line.open_lines.get(key)
            if line is None:
                opened = Plant(path) if plant is None else plant
                make = _RealTimeLine if self.realtime else _Line
                try:
                    line = make(key, opened, name or _only_bus(opened), plant is None)
                except Exception:
                    if plant is None:
                        opened.close()
                    raise
                _Line.open_lines[key] = line
            return line

    def take(self, frame: Frame) -> None:
        """A frame that was on the line."""
        if frame.error:
            if frame.own:
                self._follow_state(frame)
        elif frame.own and frame.tag in self.sent:
            self.sent.discard(frame.tag)
            if not self.receive_own_messages:
                return
            return self.frames.put(self._message(frame, is_rx=False))
        self.frames.put(self._message(frame, is_rx=True))

    def _follow_state(self, frame: Frame) -> None:
        if frame.id & CONTROLLER["bus off"]:
            self._state = can.BusState.ERROR
        elif frame.id & CONTROLLER["controller"] and frame.data[1] & PASSIVE:
            self._state = can.BusState.PASSIVE
        elif frame.id & CONTROLLER["restarted"]:
            self._state = can.BusState.ACTIVE

    def _message(self, frame: Frame, is_rx: bool) -> can.Message:
        return can.Message(
            timestamp=frame.time,
            arbitration_id=frame.id,
            is_extended_id=frame.extended,
            is_remote_frame=frame.remote,
            is_error_frame=frame.error,
            dlc=frame.length,
            data=None if frame.remote else frame.data,
            channel=self.line.name,
            is_rx=is_rx,
        )

    def _check_open(self) -> None:
        if self._closed:
            raise can.CanOperationError("the bus is shut down")

    def send(self, msg: can.Message, timeout: Optional[float] = None) -> None:
        """Queues a frame. 64 wait at most: then it waits for room, `timeout` seconds, or with None as long as it takes;
        in lockstep that is virtual time."""
        self._check_open()
        if msg.is_fd:
            raise can.CanOperationError("a plant has no CAN FD")
        if msg.is_error_frame:
            raise can.CanOperationError("error frames cannot be sent; plant.plant_fault() plants errors")
        try:
            has_room = self.line.send(self, msg, timeout)
        except (PlantError, ValueError) as error:
            raise can.CanOperationError(str(error)) from error
        if not has_room:
            raise can.CanTimeoutError(f"too many frames wait to be sent, also after {timeout or 0:g} s")

    def recv(self, timeout: Optional[float] = None) -> Optional[can.Message]:
        """The next message that fits the filters. In lockstep the timeout is virtual time."""
        if self.realtime:
            return super().recv(timeout)
        self._check_open()
        end = None if timeout is None else self.line.plant._now() + round(max(timeout, 0) * 1e9)
        while True:
            message = self._next(end)
            if message is None or self._matches_filters(message):
                return message

    def _next(self, end: Optional[int]) -> Optional[can.Message]:
        try:
            self.line.deliver()
            while not self.line.run_to(
                self.line.plant._now() + _FOR_EVER_NS if end is None else end, lambda: not self.frames.empty()
            ):
                if end is not None:
                    return None
            return self.frames.get_nowait()
        except PlantError as error:
            raise can.CanOperationError(str(error)) from error

    def _recv_internal(self, timeout: Optional[float]) -> tuple[Optional[can.Message], bool]:
        self._check_open()
        try:
            message = self.frames.get(timeout=timeout) if timeout != 0 else self.frames.get_nowait()
        except queue.Empty:
            return None, False
        if message is None:
            if self._closed:
                return None, False
            failure = getattr(self.line, "failure", None)
            raise can.CanOperationError(f"the plant has ended: {failure}") from failure
        return message, False

    def _send_periodic_internal(
        self, msgs: Union[Sequence[can.Message], can.Message], period: float, duration: Optional[float] = None
    ) -> CyclicSendTaskABC:
        if self.realtime:
            return super()._send_periodic_internal(msgs, period, duration)
        return _Cyclic(self, msgs, period, duration)

    def call(self, function: Callable[[Plant], Result]) -> Result:
        """function(plant) while time stands; in real time in the thread of the plant."""
        self._check_open()
        return self.line.call(function)

    @property
    def plant(self) -> Plant:
        """The plant; in real time it belongs to its thread, see call()."""
        return self.line.plant

    @property
    def state(self) -> can.BusState:
        return self._state

    @state.setter
    def state(self, new_state: can.BusState) -> None:
        if new_state != self._state:
            raise NotImplementedError("the state follows the line")

    def shutdown(self) -> None:
        if self._closed:
            return
        super().shutdown()
        self._closed = True
        self.line.leave(self)

    @staticmethod
    def _detect_available_configs() -> list[Any]:
        return []


def _only_bus(plant: Plant) -> str:
    lines = [name for name, bus in plant.buses.items() if bus.kind == "can"]
    if len(lines) != 1:
        raise can.CanInitializationError(f"the channel names a bus behind #; the plant has {', '.join(lines) or 'none'}")
    return lines[0]


def _refuse_fd(options: dict[str, Any]) -> None:
    """What would ask for CAN FD; a plant has none, and to take it without a word would mislead."""
    timing = options.get("timing")
    if _flag(options.get("fd", False)) or options.get("data_bitrate") is not None or hasattr(timing, "data_bitrate"):
        raise can.CanInitializationError("a plant has no CAN FD: leave out fd, data_bitrate and timings of FD")


def _flag(value: Union[bool, str]) -> bool:
    """Options of a configuration file are texts."""
    return value if isinstance(value, bool) else str(value).strip().lower() in ("1", "true", "yes", "on")
