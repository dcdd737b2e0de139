"""Drives the stations of profile.toml over vcan0 with python3-can: parameter channel and process data of the MOVILINK
profile on SBus. Telegrams worked out from 1053 1610 p. 29-31 (parameter channel), p. 38 (identifiers), p. 39 (process
data), p. 71-83 (parameters) and p. 46 (return codes)."""
import sys
import time

import can

from checks import check

ADDRESS = 1  # P813 of unit1
GROUP = 2  # P814 of both units
READ, WRITE, WRITE_VOLATILE, MINIMUM, MAXIMUM, DEFAULT = 1, 2, 3, 4, 5, 6
P000_SPEED, P130_RAMP, P094_PO1, STATUS_WORD_1 = 8318, 8470, 8455, 8310


class Master:
    def __init__(self, channel):
        self.bus = can.Bus(interface="socketcan", channel=channel)

    def send(self, identifier, data):
        self.bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False))

    def receive(self, identifier, timeout=30.0):
        """Data of the next frame with this identifier as hexadecimal text, None when there is none in time."""
        end = time.monotonic() + timeout
        while (left := end - time.monotonic()) > 0:
            frame = self.bus.recv(left)
            if frame is not None and frame.arbitration_id == identifier:
                return frame.data.hex().upper()
        return None

    def parameter(self, service, index, value=0, address=ADDRESS, timeout=30.0):
        # Length code 11 (4 bytes) in bits 4 and 5 of the management byte.
        request = bytes([0x30 | service, 0]) + index.to_bytes(2, "big") + (value & 0xFFFFFFFF).to_bytes(4, "big")
        self.send(8 * address + 515, request)
        return self.receive(8 * address + 516, timeout)

    def process(self, words, address=ADDRESS):
        self.send(8 * address + 3, b"".join(word.to_bytes(2, "big") for word in words))
        return self.receive(8 * address + 4)


def parameter_channel(master):
    check("factory setting of P130 is 2.000 s", master.parameter(READ, P130_RAMP), "31002116000007D0")
    check("a write is answered", master.parameter(WRITE, P130_RAMP, 3000), "3200211600000BB8")
    check("and read back", master.parameter(READ, P130_RAMP), "3100211600000BB8")
    check("minimum", master.parameter(MINIMUM, P130_RAMP), "3400211600000000")
    check("maximum is 2000 s", master.parameter(MAXIMUM, P130_RAMP), "35002116001E8480")
    check("default", master.parameter(DEFAULT, P130_RAMP), "36002116000007D0")
    check("beyond the maximum: class 8, 15h", master.parameter(WRITE, P130_RAMP, 2000010), "B200211608000015")
    check("below the minimum: class 8, 16h", master.parameter(WRITE, P130_RAMP, -10), "B200211608000016")
    check("a refused write changes nothing", master.parameter(READ, P130_RAMP), "3100211600000BB8")
    check("read-only: class 8, 12h", master.parameter(WRITE, P000_SPEED, 1), "B200207E08000012")
    check("index that is not there: class 8, 11h", master.parameter(READ, 8415), "B10020DF08000011")
    check("service 15: class 5, code 5", master.parameter(15, P000_SPEED), "BF00207E05050000")
    check("volatile write", master.parameter(WRITE_VOLATILE, P130_RAMP, 500), "33002116000001F4")
    check("no station 3", master.parameter(READ, P130_RAMP, address=3, timeout=0.5), None)


def group_parameter(master):
    master.send(8 * GROUP + 518, bytes.fromhex("3200211600000FA0"))  # 4000
    check("a group write is not answered", master.receive(8 * GROUP + 516, 0.1), None)
    for address in (1, 2):
        check(f"group write at unit {address}", master.parameter(READ, P130_RAMP, address=address), "3100211600000FA0")


def process_data(master):
    # Status word 1 (1053 1610 p. 41): state in the high byte, ready (bit 1) and PO data enabled (bit 2) in the low
    # one; then speed and output current of a standing drive.
    check("controller inhibit: state 1", master.process((0x0001, 5000, 15000)), "010600000000")
    for word, value in enumerate((0x0001, 5000, 15000)):
        check(f"PO{word + 1} is shown", master.parameter(READ, P094_PO1 + word)[8:], f"{value:08X}")
    check("no enable: state 2", master.process((0x0000, 5000, 15000)), "020600000000")
    master.send(8 * GROUP + 6, bytes.fromhex("000113883A98"))
    check("a group PO telegram is not answered", master.receive(8 * ADDRESS + 4, 0.1), None)
    check("but taken", master.parameter(READ, P094_PO1)[8:], "00000001")


def cyclic(master, words, done):
    """The same PO telegram every 20 ms, within P815 = 3 s; the first PI telegram that is as wanted, or the last one."""
    end = time.monotonic() + 60
    while True:
        reply = master.process(words)
        if done(reply) or time.monotonic() >= end:
            return reply
        time.sleep(0.02)


def speed(reply):
    return int(reply[4:8], 16)


def enable_and_speed(master):
    """Control word 6 is enable; 5000 digits are 1000 rpm (p. 48). Speed is reached after the ramp P130."""
    master.process((0x0000, 0, 0))
    # Silent for longer than P815: F47 is pending (p. 64). Questions of the parameter channel are no process data.
    end = time.monotonic() + 60
    while master.parameter(READ, STATUS_WORD_1)[12:14] != "2F" and time.monotonic() < end:
        time.sleep(0.2)
    check("F47 after silence", master.process((0x0006, 5000, 0))[:4], "2F24")
    master.process((0x0040, 0, 0))  # reset, 0 -> 1
    master.parameter(WRITE_VOLATILE, P130_RAMP, 500)
    reply = cyclic(master, (0x0006, 5000, 0), lambda reply: abs(speed(reply) - 5000) <= 10)
    check("enabled: state 4, output stage on", reply[:4], "0407")
    check("speed is 1000 rpm", abs(speed(reply) - 5000) <= 10, True)
    check("rapid stop ends at 0 rpm", cyclic(master, (0x0000, 0, 0), lambda reply: speed(reply) == 0)[4:8], "0000")


def main():
    master = Master("vcan0")
    parameter_channel(master)
    group_parameter(master)
    process_data(master)
    enable_and_speed(master)
    print("end")


sys.exit(main())
