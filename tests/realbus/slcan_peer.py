"""slcan_peer.py IPOS PLANT PATH: attaches python3-can's slcan interface to the pseudo-terminal PATH of a running plant
(the SCOM example, 1053 1610 p. 57-59) and talks to its stations."""
import subprocess
import sys
import time

import can

from checks import check

ipos, plant, path = sys.argv[1:]
run = subprocess.Popen([ipos, "run", plant, "--realtime", "--for", "1000s"], stderr=subprocess.PIPE, text=True)
run.stderr.readline()  # "... is joined to ..."


def attach(bitrate):
    return can.Bus(interface="slcan", channel=path, bitrate=bitrate, sleep_after_open=0.05)


def frames(bus, seconds, enough=lambda found: False):
    """What comes until it is enough, or so long."""
    end = time.monotonic() + seconds
    found = []
    while not enough(found) and (left := end - time.monotonic()) > 0:
        frame = bus.recv(left)
        if frame is not None:
            found.append((frame.arbitration_id, frame.is_extended_id, frame.data.hex().upper()))
    return found


PATIENCE = 60  # s; of a loaded machine


def count(found, identifier):
    return sum(frame[0] == identifier for frame in found)


def both_units(found):
    return count(found, 1024) > 0 and count(found, 1025) > 0


bus = attach(500000)
check("version", bus.get_version(1.0), (1, 1))
check("serial number", bus.get_serial_number(1.0), "IPOS")
seen = frames(bus, PATIENCE, lambda found: count(found, 1024) == 12)
check("unit 1", set(seen) >= {(1024, False, "5566778811223344")}, True)
check("unit 2", set(seen) >= {(1025, False, "8877665544332211")}, True)
check("nobody else", len(set(seen)), 2)
check("100 ms and 120 ms: ten frames of unit 2 beside twelve of unit 1", 9 <= count(seen, 1025) <= 11, True)
bus.send(can.Message(arbitration_id=523, data=bytes.fromhex("3100211600000000"), is_extended_id=False))
check("parameter response", frames(bus, PATIENCE, lambda found: count(found, 524))[-1:], [(524, False, "31002116000007D0")])
bus.send(can.Message(arbitration_id=0x12345678, data=b"", is_extended_id=True))
bus.send(can.Message(arbitration_id=1025, is_remote_frame=True, dlc=8, is_extended_id=False))
check("other frames disturb nobody", set(frames(bus, PATIENCE, both_units)), set(seen))
bus.shutdown()

# With another bit rate nothing is heard, and the other side knows why.
bus = attach(250000)
check("wrong bit rate", frames(bus, 0.3), [])
bus.shutdown()

bus = attach(500000)
check("attached again", set(frames(bus, PATIENCE, both_units)), set(seen))
bus.shutdown()

run.terminate()
errors = run.stderr.read()
check("ended by the signal", run.wait(), 130)
check("the wrong bit rate is told", "asks for 250000 bit/s, the bus has 500000" in errors, True)
print("end")
