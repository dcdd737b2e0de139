"""movilink_peer.py IPOS PLANT PATH: a MOVILINK master on RS-485 that knows nothing of ipos, with python3-serial over the
pseudo-terminal PATH of a running plant (movilink.toml). Telegrams by 1053 1610 p. 18-34: SD1 02 / SD2 1D, address, type,
PDU, exclusive-or; parameters p. 71-83, return codes p. 46, status word p. 41."""
import os
import subprocess
import sys
import time

import serial

from checks import check

CHARACTER = 11 / 9600
READ, WRITE, WRITE_VOLATILE, MINIMUM, MAXIMUM, DEFAULT = 1, 2, 3, 4, 5, 6
P000, P094, P130, P812 = 8318, 8455, 8470, 8599


# Behind the last character; a host that is late has its answer on the simulated line for longer.
PAUSE = float(os.environ.get("IPOS_PAUSE", "0.004"))


def checksum(data):
    value = 0
    for byte in data:
        value ^= byte
    return value


class Master:
    def __init__(self, path):
        self.line = serial.Serial(path, baudrate=9600, bytesize=8, parity=serial.PARITY_EVEN, stopbits=1, timeout=0.3)
        self.quiet = 0.0

    def send(self, address, kind, pdu, pause=PAUSE):
        """At least `pause` after the last character; then the time a wire would need."""
        time.sleep(max(0.0, self.quiet + pause - time.monotonic()))
        data = bytes([0x02, address, kind]) + pdu
        self.line.reset_input_buffer()
        self.line.write(data + bytes([checksum(data)]))
        self.quiet = time.monotonic() + (len(data) + 1) * CHARACTER

    def ask(self, address, kind, pdu, tries=3):
        """PDU of the answer as hexadecimal text; None without a good one. A busy machine may tear a telegram."""
        for _ in range(tries):
            self.send(address, kind, pdu)
            answer = self.line.read(len(pdu) + 4)
            self.quiet = time.monotonic()
            if len(answer) == len(pdu) + 4 and answer[0] == 0x1D and answer[2] == kind and checksum(answer) == 0:
                return answer[3:-1].hex().upper()
        return None

    def parameter(self, service, index, value=0, address=1, tries=3):
        return self.ask(address, 0x86, channel(service, index, value), tries)


def channel(service, index, value=0, bit=0):
    return bytes([0x30 | bit << 6 | service, 0]) + index.to_bytes(2, "big") + (value & 0xFFFFFFFF).to_bytes(4, "big")


def words(*values):
    return b"".join(value.to_bytes(2, "big") for value in values)


def parameters(master):
    check("read P130: 2.000 s", master.parameter(READ, P130), "31002116000007D0")
    check("write", master.parameter(WRITE, P130, 3000), "3200211600000BB8")
    check("read back", master.parameter(READ, P130), "3100211600000BB8")
    check("write volatile", master.parameter(WRITE_VOLATILE, P130, 500), "33002116000001F4")
    check("minimum", master.parameter(MINIMUM, P130), "3400211600000000")
    check("maximum is 2000 s", master.parameter(MAXIMUM, P130), "35002116001E8480")
    check("default", master.parameter(DEFAULT, P130), "36002116000007D0")
    check("beyond the maximum: class 8, 15h", master.parameter(WRITE, P130, 2000010), "B200211608000015")
    check("below the minimum: class 8, 16h", master.parameter(WRITE, P130, -10), "B200211608000016")
    check("read only: class 8, 12h", master.parameter(WRITE, P000, 1), "B200207E08000012")
    check("no such index: class 8, 11h", master.parameter(READ, 8415), "B10020DF08000011")
    check("nobody at address 9", master.parameter(READ, P130, address=9, tries=1), None)


def rules_of_the_line(master):
    good = channel(READ, P130)
    master.send(1, 0x86, good)
    master.line.read(12)
    data = bytes([0x02, 1, 0x86]) + good
    time.sleep(0.02)
    master.line.write(data + bytes([checksum(data) ^ 1]))
    check("a wrong block check is not answered", master.line.read(12), b"")
    master.line.write(data[:6])
    time.sleep(6 * CHARACTER + 0.02)
    master.line.write(data[6:] + bytes([checksum(data)]))
    check("a gap voids the telegram", master.line.read(12), b"")
    master.quiet = time.monotonic()
    check("type 07 is not answered", master.ask(1, 0x07, words(0, 0), 1), None)
    check("then it goes on", master.parameter(READ, P130)[:8], "31002116")


def groups(master):
    for attempt in range(3):
        master.send(101, 0x86, channel(WRITE, P130, 4000))
        check("a group is not answered", master.line.read(12), b"")
        master.quiet = time.monotonic()
        if all(master.parameter(READ, P130, address=a) == "3100211600000FA0" for a in (1, 2)):
            break
    for address, value in ((1, "00000FA0"), (2, "00000FA0"), (3, "000007D0")):
        check(f"unit {address} after the group telegram", master.parameter(READ, P130, address=address)[8:], value)
    for attempt in range(3):
        master.send(255, 0x81, words(0x0001))
        master.quiet += 0.021  # 25 ms in all before the next request
        if master.parameter(READ, P094, address=3)[8:] == "00000001":
            break
    check("a broadcast reaches all", [master.parameter(READ, P094, address=a)[8:] for a in (1, 2, 3)], ["00000001"] * 3)
    check("answers to 254 collide", master.ask(254, 0x86, channel(READ, P130), 1), None)


def handshake(master):
    """Figure 22: prepare with the bit as it is, change it, repeat until the answer has it."""
    present = master.ask(1, 0x06, channel(0, 0, 0, 0))
    bit = int(present[0:2], 16) >> 6 & 1
    for value in (2500, 2600, 2700):
        master.ask(1, 0x06, channel(WRITE, P130, value, bit))
        check("prepared, not written", master.parameter(READ, P130)[8:] != f"{value:08X}", True)
        bit ^= 1
        for _ in range(50):
            answer = master.ask(1, 0x06, channel(WRITE, P130, value, bit))
            if answer is not None and int(answer[0:2], 16) >> 6 & 1 == bit:
                break
        check("handed over", answer, channel(WRITE, P130, value, bit).hex().upper())
        check("written once", master.parameter(READ, P130)[8:], f"{value:08X}")


def timeout(master):
    """P812 watches cyclic requests only; F43 = 2Bh in the high byte of status word 1, bit 5."""
    master.parameter(WRITE_VOLATILE, P812, 600)
    for _ in range(6):
        time.sleep(0.15)
        status = master.ask(2, 0x81, words(0x0001))
    check("acyclic requests are not watched", int(status, 16) & 0x20, 0)
    status = master.ask(1, 0x01, words(0x0001))
    check("no fault while it talks", int(status, 16) & 0x20, 0)
    time.sleep(1.2)
    status = master.ask(1, 0x81, words(0x0001))
    check("F43 after silence", status[:2], "2B")
    check("bit 5", int(status, 16) & 0x20, 0x20)


ipos, plant, path = sys.argv[1:]
run = subprocess.Popen([ipos, "run", plant, "--realtime", "--for", "100s"], stderr=subprocess.PIPE, text=True)
run.stderr.readline()  # "... is joined to ..."
try:
    connected = Master(path)
    parameters(connected)
    rules_of_the_line(connected)
    groups(connected)
    handshake(connected)
    timeout(connected)
finally:
    run.terminate()
    errors = run.stderr.read()
    check("ended by the signal", run.wait(), 130)
print("end")
