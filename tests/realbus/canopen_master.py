"""canopen_master.py IPOS PLANT PATH EDS LOG CYCLES: a CANopen master that follows CiA 301 and knows nothing of ipos but
the EDS, with python3-can at the pseudo-terminal PATH of a running plant of three nodes, 5, 6 and 7 (canopen.toml). A PATH
without a slash is a CAN interface of the kernel."""
import collections
import configparser
import subprocess
import sys
import time

import can

from checks import check

ipos, plant, path, eds_path, log, cycles = sys.argv[1:]
cycles = int(cycles)
NODES = (5, 6, 7)
# An interface has no memory: who comes later has not heard the boot-up.
bus = can.Bus(interface="socketcan", channel=path) if "/" not in path else None
run = subprocess.Popen([ipos, "run", plant, "--realtime", "--for", "600s", "--log", log],
                       stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
run.stderr.readline()  # "... is joined to ..."
bus = bus or can.Bus(interface="slcan", channel=path, bitrate=1000000, sleep_after_open=0.05)


def send(identifier, data=b"", remote=False):
    bus.send(can.Message(arbitration_id=identifier, data=data, is_extended_id=False, is_remote_frame=remote,
                         dlc=1 if remote else None))


def receive(wanted, seconds=30.0):
    """The next frame with one of these identifiers, or None. Others are kept as they came."""
    end = time.monotonic() + seconds
    while (left := end - time.monotonic()) > 0:
        frame = bus.recv(left)
        if frame is None:
            continue
        if frame.arbitration_id in wanted:
            return frame
        others.append(frame)
    return None


others = []


class Abort(Exception):
    def __init__(self, code):
        super().__init__(f"{code:08X}")
        self.code = code


def ask(node, request):
    send(0x600 + node, bytes(request).ljust(8, b"\0"))
    answer = receive([0x580 + node])
    if answer is None:
        raise Abort(0x05040000)
    if answer.data[0] == 0x80:
        raise Abort(int.from_bytes(answer.data[4:8], "little"))
    return bytes(answer.data)


def read(node, index, sub=0):
    answer = ask(node, bytes([0x40]) + index.to_bytes(2, "little") + bytes([sub]))
    assert answer[1:4] == index.to_bytes(2, "little") + bytes([sub]), answer.hex()
    if answer[0] & 2:
        return answer[4:8 - (answer[0] >> 2 & 3)]
    size, data, toggle = int.from_bytes(answer[4:8], "little"), b"", 0
    while True:
        answer = ask(node, [0x60 | toggle])
        assert answer[0] & 0x10 == toggle, answer.hex()
        data += answer[1:8 - (answer[0] >> 1 & 7)]
        if answer[0] & 1:
            assert len(data) == size, (data, size)
            return data
        toggle ^= 0x10


def write(node, index, sub, value, length):
    data = (value & (1 << 8 * length) - 1).to_bytes(length, "little")
    ask(node, bytes([0x23 | 4 - length << 2]) + index.to_bytes(2, "little") + bytes([sub]) + data)


def refusal(node, index, sub, value, length):
    try:
        write(node, index, sub, value, length)
    except Abort as abort:
        return abort.code
    return 0


# Boot-up: reset communication makes each node say so. A plant that does not run yet hears no reset, so it is sent again.
boots = set()
for _ in range(20):
    send(0x000, [0x82, 0])
    while len(boots) < len(NODES) and (frame := receive([0x700 + node for node in NODES], 5.0)):
        boots.add(frame.arbitration_id)
    if len(boots) == len(NODES):
        break
check("boot-up", sorted(boots), [0x705, 0x706, 0x707])

# Every object of the EDS: read in its length; written at its limits and beyond; refused where it is read only.
eds = configparser.ConfigParser()
eds.optionxform = str
eds.read(eds_path)
LENGTHS = {4: 4, 5: 1, 6: 2, 7: 4}
counts = collections.Counter()
wrong = []
for section in eds.sections():
    entry = eds[section]
    index, _, sub = section.partition("sub")
    try:
        index, sub = int(index, 16), int(sub or "0", 16)
    except ValueError:
        continue
    if len(section) < 4 or "DataType" not in entry or index < 0x1000:
        continue
    kind, access = int(entry["DataType"], 0), entry["AccessType"]
    try:
        value = read(5, index, sub)
    except Abort as abort:
        if index == 0x1003 and sub > 0 and "08000024" in str(abort):
            continue  # no error has been stored (CiA 301, 1003h)
        wrong.append(f"{section} read {abort}")
        continue
    counts["read"] += 1
    length = LENGTHS.get(kind)
    if length is not None and len(value) != length:
        wrong.append(f"{section} {len(value)} bytes")
    if not access.startswith("rw"):
        if (code := refusal(5, index, sub, 0, length or 4)) != 0x06010002:
            wrong.append(f"{section} read only {code:08X}")
        counts["read only"] += 1
        continue
    if index < 0x206C:  # communication objects have rules of their own
        continue
    present = int.from_bytes(value, "little", signed=True)
    code = refusal(5, index, sub, present, 4)
    needs_inhibit = code == 0x08000022  # the drive is not inhibited here: the state of the device
    counts["written" if code == 0 else "needs inhibit" if needs_inhibit else f"written {code:08X}"] += 1
    for key, step, expected in (("LowLimit", -1, 0x06090032), ("HighLimit", 1, 0x06090031)):
        if key not in entry:
            continue
        beyond = int(entry[key], 0) + step
        if not -0x80000000 <= beyond <= 0x7FFFFFFF or (kind == 7 and beyond < 0):
            continue
        if (code := refusal(5, index, sub, beyond, 4)) != (0x08000022 if needs_inhibit else expected):
            wrong.append(f"{section} := {beyond} {code:08X}")
        counts["beyond"] += 1
    if (code := refusal(5, index, sub, present, 2)) != 0x06070010:
        wrong.append(f"{section} two bytes {code:08X}")
print("counts", dict(counts), flush=True)
check("every object answers as the EDS says", wrong, [])
check("objects read", counts["read"] > 500, True)
check("written as they were", counts["written"] > 200, True)
check("written beyond their limits", counts["beyond"] > 300, True)
check("no object", refusal(5, 0x1F00, 0, 0, 4), 0x06020000)

# Remapping in the order of CiA 301: TPDO2 of node 6 carries PI2 and PI1, at each SYNC.
check("mapping of a PDO that is on", refusal(6, 0x1A00, 0, 0, 1), 0x06010000)
write(6, 0x1801, 2, 1, 1)
write(6, 0x1A01, 0, 0, 1)
write(6, 0x1A01, 1, 0x20010210, 4)
write(6, 0x1A01, 2, 0x20010110, 4)
write(6, 0x1A01, 0, 2, 1)
write(6, 0x1801, 1, 0x286, 4)
send(0x000, [0x01, 0])
send(0x080)
first, second = receive([0x186]), receive([0x286])
check("remapped", bytes(second.data), bytes(first.data[2:4] + first.data[0:2]))
write(6, 0x1801, 1, 0x80000286, 4)

# SYNC: each node takes its setpoints and answers once; the count of answers is that of the SYNCs.
answers = collections.Counter()
others.clear()
begin = time.monotonic()
for cycle in range(cycles):
    for node in NODES:
        send(0x200 + node, (6).to_bytes(2, "little") + (2500 + node).to_bytes(2, "little") + b"\0\0")
    send(0x080)
    for _ in NODES:
        frame = receive([0x185, 0x186, 0x187])
        if frame is not None:
            answers[frame.arbitration_id] += 1
print(f"{cycles} cycles in {time.monotonic() - begin:.1f} s", flush=True)
check("one answer of each node at each SYNC", dict(answers), {0x180 + node: cycles for node in NODES})
check("nothing else was said", [frame.arbitration_id for frame in others], [])
end = time.monotonic() + 30
speed = 0
while speed != 2505 and time.monotonic() < end:
    time.sleep(0.05)
    send(0x080)
    speed = int.from_bytes(receive([0x185]).data[2:4], "little")
check("the first drive runs at its setpoint", speed, 2505)

# Guarding of node 7: the toggle bit, and what is said when the requests stay away.
write(7, 0x100C, 0, 2000, 2)
write(7, 0x100D, 0, 2, 1)
check("guarding and heartbeat exclude each other", refusal(7, 0x1017, 0, 100, 2), 0x06040043)
states = []
for _ in range(4):
    send(0x707, remote=True)
    states.append(receive([0x707]).data[0])
    time.sleep(0.05)
check("the toggle bit", states, [0x05, 0x85, 0x05, 0x85])
emergencies = [bytes(receive([0x087]).data) for _ in range(2)]
check("EMCY of the guarding and of the fault", sorted(e[0:2] for e in emergencies), [b"\x00\xFF", b"\x30\x81"])
write(7, 0x100C, 0, 0, 2)
send(0x207, bytes([0x40, 0, 0, 0, 0, 0]))  # fault reset, bit 6 of control word 1
send(0x080)
gone = []
while len(gone) < 2 and (frame := receive([0x087], 5.0)) is not None:
    gone.append(bytes(frame.data))
check("EMCY that all is over", gone[-1][0:3] if gone else None, b"\0\0\0")
check("error register", read(7, 0x1001), b"\0")

# Heartbeat of node 6.
write(6, 0x1017, 0, 50, 2)
beats = [receive([0x706]).data[0] for _ in range(3)]
check("heartbeat", beats, [5, 5, 5])
send(0x000, [0x80, 0])
check("pre-operational", receive([0x706]).data[0] in (0x05, 0x7F), True)
others.clear()
send(0x080)
check("no process data before operational", receive([0x185, 0x186, 0x187], 0.2), None)
bus.shutdown()
run.terminate()
run.wait()
print("end")
