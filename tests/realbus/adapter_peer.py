"""adapter_peer.py INTERFACE CHANNEL LIBRARY: python3-can drives the stand-in for a maker's library with declarations of its
own, and talks to a port of ipos on the same bus. So what ipos and the stand-ins declare is what others know of these libraries.
Two of them exist for Windows only: python3-can is told that LIBRARY is the one that it looks for, and that `long` has 32 bits."""
import ctypes
import os.path
import sys
import time

interface, channel, library = sys.argv[1:]

if interface in ("vector", "ixxat"):
    ctypes.c_long, ctypes.c_ulong = ctypes.c_int32, ctypes.c_uint32

    class Loader:
        @staticmethod
        def LoadLibrary(name):
            return ctypes.CDLL(library)

    ctypes.windll = Loader

import can
import can.ctypesutil

from checks import check

options = {}
if interface == "vector":
    options = {"_testing": True, "app_name": None}
if interface == "ixxat":
    platform, sys.platform = sys.platform, "win32"
    Known = can.ctypesutil.CLibrary
    can.ctypesutil.HRESULT = ctypes.c_int32

    class OurLibrary(Known):
        def __init__(self, name):
            if name != "vcinpl.dll":
                raise OSError(name)  # vcinpl2.dll
            super().__init__(library)

    can.ctypesutil.CLibrary = OurLibrary
    from can.interfaces.ixxat import canlib_vcinpl

    sys.platform = platform
    bus = canlib_vcinpl.IXXATBus(int(channel), bitrate=250000, extended=True)
else:
    bus = can.Bus(interface=interface, channel=channel if interface == "pcan" else int(channel), bitrate=250000, **options)

FRAMES = [
    can.Message(arbitration_id=0x123, data=bytes([1, 2, 3]), is_extended_id=False),
    can.Message(arbitration_id=0x7FF, data=bytes(range(0xF8, 0x100)), is_extended_id=False),
    can.Message(arbitration_id=0, data=b"", is_extended_id=False),
    can.Message(arbitration_id=0x1ABCDEF0, data=bytes([0, 0x80, 0xFF, 0x7F]), is_extended_id=True),
    can.Message(arbitration_id=0x321, is_remote_frame=True, dlc=5, is_extended_id=False),
]


def seen(message):
    return (message.arbitration_id, message.is_extended_id, message.is_remote_frame, message.dlc,
            "" if message.is_remote_frame else bytes(message.data).hex())


def mirrored(message):
    """What the other side answers: the identifier by one more, the data with all bits turned."""
    identifier = (message.arbitration_id + 1) % (0x20000000 if message.is_extended_id else 0x800)
    return (identifier, message.is_extended_id, message.is_remote_frame, message.dlc,
            "" if message.is_remote_frame else bytes(byte ^ 0xFF for byte in message.data).hex())


print("ready", flush=True)
for frame in FRAMES:
    bus.send(frame)
    end = time.monotonic() + 60
    answer = None
    while answer is None and time.monotonic() < end:
        answer = bus.recv(0.1)
    check(f"answer to {frame.arbitration_id:X}", answer and seen(answer), mirrored(frame))
check("and no more", bus.recv(0.05), None)
bus.shutdown()
print("end")
