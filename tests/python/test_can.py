"""The python-can backend: what is written for python-can runs on the CAN line of a plant."""

import threading
import time

import pytest

can = pytest.importorskip("can")
can_ipos = pytest.importorskip("ipos.can")

import ipos
from conftest import LINE

CHANNEL = LINE + "#sbus"


@pytest.fixture
def bus():
    with can.Bus(interface="ipos", channel=CHANNEL) as opened:
        yield opened


def test_recv_moves_virtual_time_to_the_next_frame(bus):
    first = bus.recv(1)
    second = bus.recv(1)
    # The saw sends its cyclic object 1024 every 100 ms.
    assert first.arbitration_id == second.arbitration_id == 0x400
    assert second.timestamp - first.timestamp == pytest.approx(0.1, abs=1e-4)
    assert bus.plant.time == pytest.approx(second.timestamp, abs=1e-9)
    assert first.is_rx and first.dlc == 8 and first.channel == "sbus"


def test_a_timeout_passes_in_virtual_time_alone(bus):
    bus.set_filters([{"can_id": 0x7FF, "can_mask": 0x7FF}])
    begin = time.monotonic()
    assert bus.recv(20) is None
    assert bus.plant.time == pytest.approx(20)
    assert time.monotonic() - begin < 20
    assert bus.recv(0) is None and bus.plant.time == pytest.approx(20)


def test_filters_let_through_what_fits(bus):
    bus.set_filters([{"can_id": 0x20B, "can_mask": 0x7FF, "extended": False}])
    with can.Bus(interface="ipos", channel=CHANNEL) as other:
        other.send(can.Message(arbitration_id=0x20B, data=[1], is_extended_id=False))
        other.send(can.Message(arbitration_id=0x20B, data=[2], is_extended_id=True))
        message = bus.recv(1)
        assert message.data == b"\1" and not message.is_extended_id
        assert bus.recv(0.5) is None


def test_two_buses_of_one_channel_hear_each_other(bus):
    with can.Bus(interface="ipos", channel=CHANNEL, receive_own_messages=True) as other:
        assert other.plant is bus.plant
        for each in (bus, other):
            each.set_filters([{"can_id": 0x1ABCDEF0, "can_mask": 0x1FFFFFFF}, {"can_id": 7, "can_mask": 0x7FF}])
        message = can.Message(arbitration_id=0x1ABCDEF0, data=bytes(8), is_extended_id=True)
        other.send(message)
        heard, own = bus.recv(1), other.recv(1)
        assert heard.arbitration_id == 0x1ABCDEF0 and heard.is_extended_id and heard.is_rx
        assert own.arbitration_id == 0x1ABCDEF0 and not own.is_rx and own.timestamp == heard.timestamp
        bus.send(can.Message(arbitration_id=0x7, is_remote_frame=True, dlc=3, is_extended_id=False))
        remote = other.recv(1)
        assert remote.is_remote_frame and remote.dlc == 3


def test_a_frame_takes_its_time_on_the_line(bus):
    bus.send(can.Message(arbitration_id=0x123, data=bytes(range(8)), is_extended_id=False))
    with can.Bus(interface="ipos", channel=CHANNEL, receive_own_messages=True) as other:
        frame = other.recv(1)
    # 111 bits without stuff bits and intermission at 2 us, and stuff bits.
    assert 108 * 2e-6 <= frame.timestamp <= 135 * 2e-6 + 4e-6


def test_cyclic_messages_go_out_in_virtual_time(bus):
    with can.Bus(interface="ipos", channel=CHANNEL) as other:
        task = bus.send_periodic(can.Message(arbitration_id=0x123, data=[7], is_extended_id=False), 0.01, duration=0.1)
        other.set_filters([{"can_id": 0x123, "can_mask": 0x7FF}])
        times = [message.timestamp for message in iter(lambda: other.recv(0.05), None)]
        assert len(times) == 10
        assert [b - a for a, b in zip(times, times[1:])] == pytest.approx([0.01] * 9, abs=3e-4)
        task.stop()


def test_a_given_plant_stays_open():
    with ipos.Plant(LINE) as plant:
        with can.Bus(interface="ipos", channel="sbus", plant=plant) as bus:
            assert bus.recv(1).arbitration_id == 0x400
        assert plant.time > 0


def test_refusals_are_those_of_python_can(bus):
    for channel in ("nowhere.toml#sbus", LINE + "#can7", "", None):
        with pytest.raises(can.CanInitializationError):
            can.Bus(interface="ipos", channel=channel)
    with pytest.raises(can.CanOperationError):
        bus.send(can.Message(arbitration_id=1, is_fd=True, data=bytes(16)))
    for options in ({"fd": True}, {"fd": "true"}, {"data_bitrate": 2_000_000}, {"bitrate": 250_000}, {"bitrate": "125000"}):
        with pytest.raises(can.CanInitializationError, match="CAN FD|500000 bit/s"):
            can.Bus(interface="ipos", channel=CHANNEL, **options)
    can.Bus(interface="ipos", channel=CHANNEL, bitrate=500_000, fd=False).shutdown()
    bus.shutdown()
    with pytest.raises(can.CanOperationError):
        bus.send(can.Message(arbitration_id=1))
    with pytest.raises(can.CanOperationError):
        bus.recv(0)


BURST = 300  # frames; 64 wait in a station of a plant, and python-can wants the rest to wait for room


def numbered(number):
    return can.Message(arbitration_id=0x300 + number, data=[7], is_extended_id=False)


def burst_of(bus):
    """The identifiers of a burst that came, in their order: waits for them, not for a time."""
    heard = []
    while len(heard) < BURST:
        message = bus.recv(60)
        assert message is not None, f"{len(heard)} of {BURST} frames came within 60 s"
        if message.data == b"\7":
            heard.append(message.arbitration_id - 0x300)
    return heard


@pytest.mark.parametrize("timeout", [None, 5])
@pytest.mark.parametrize("realtime", [False, True])
def test_send_waits_for_room(realtime, timeout):
    with can.Bus(interface="ipos", channel=CHANNEL, realtime=realtime) as bus:
        with can.Bus(interface="ipos", channel=CHANNEL, realtime=realtime) as other:
            for number in range(BURST):
                bus.send(numbered(number), timeout=timeout)
            assert burst_of(other) == list(range(BURST))


def test_a_burst_from_the_thread_of_the_plant():
    with can.Bus(interface="ipos", channel=CHANNEL, realtime=True) as bus:
        bus.call(lambda _: [bus.send(numbered(number)) for number in range(BURST)])


def test_a_timeout_of_send_ends(bus):
    bus.plant.run("1ms")
    before = bus.plant.time_us
    with pytest.raises(can.CanTimeoutError, match="too many frames wait"):
        for number in range(BURST):
            bus.send(numbered(number), timeout=0)
    assert bus.plant.time_us == before  # a frame of 8 bytes takes a quarter of a millisecond
    with pytest.raises(can.CanTimeoutError, match="after 1e-05 s"):
        for number in range(2):
            bus.send(numbered(number), timeout=1e-5)
    assert bus.plant.time_us == before + 10
    bus.send(numbered(1), timeout=0.001)


# python-canopen's network.scanner.search(): a question to each of the 127 nodes.
def test_a_scanner_asks_all_nodes():
    with can.Bus(interface="ipos", channel=CHANNEL, realtime=True) as bus:
        for node in range(1, 128):
            bus.send(can.Message(arbitration_id=0x600 + node, data=[0x40, 0, 0x10, 0, 0, 0, 0, 0], is_extended_id=False))


def test_error_frames_and_state(bus):
    bus.call(lambda plant: plant.plant_fault("sbus", "stuck"))
    bus.send(can.Message(arbitration_id=0x123, is_extended_id=False))
    errors = [message for message in iter(lambda: bus.recv(0.5), None) if message.is_error_frame]
    assert errors
    assert bus.state in (can.BusState.PASSIVE, can.BusState.ERROR)


def test_real_time_with_a_notifier_and_another_thread():
    with can.Bus(interface="ipos", channel=CHANNEL, realtime=True) as bus:
        heard: list[can.Message] = []
        enough = threading.Event()

        def listen(message):
            heard.append(message)
            if sum(each.arbitration_id == 0x400 for each in heard) == 3:
                enough.set()

        notifier = can.Notifier(bus, [listen], timeout=0.1)
        assert enough.wait(30)
        bus.send(can.Message(arbitration_id=0x321, is_extended_id=False))
        bus.send_periodic(can.Message(arbitration_id=0x322, is_extended_id=False), 0.01, duration=0.05)
        count = bus.call(lambda plant: plant["saw"]["lCount"])
        assert count > 0
        with pytest.raises(ipos.ThreadError):
            bus.plant.time
        notifier.stop()
        cyclic = [message.timestamp for message in heard if message.arbitration_id == 0x400]
        assert cyclic[1] - cyclic[0] == pytest.approx(0.1, abs=1e-4)
    assert can_ipos._Line.open_lines == {}
