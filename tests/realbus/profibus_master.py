"""profibus_master.py IPOS PLANT PATH EXCHANGES [DAMAGED [CARELESS [LOG]]]: a PROFIBUS-DP master of class 1 that follows EN
50170 and knows nothing of ipos, at the pseudo-terminal PATH of a running plant of two slaves, 8 and 9
(profibus_plant.toml). EXCHANGES without a fault, DAMAGED with 1 % of the frames damaged in both directions, then
CARELESS things that no master may send. 1000000 exchanges are the long form."""
import collections
import os
import random
import re
import select
import subprocess
import sys
import time
import tty

from checks import check

MASTER, SLAVES, SAP_MASTER = 1, (8, 9), 62
DIAG, PRM, CFG, GET_CFG, RD_IN, RD_OUT, GLOBAL = 60, 61, 62, 59, 56, 57, 58
IDENT = {8: 0x3100, 9: 0x3111}
WATCHDOG = 0.4                 # seconds
SLOT = 0.05                    # a PC's slot time: far more than the 200 bits of the norm, and less than the watchdog
TRIES = 3
SPEED = 1500                   # digits of 0.2 rpm


def sd2(da, sa, fc, data=b"", sap=None):
    body = bytes([da | (0x80 if sap else 0), sa | (0x80 if sap else 0), fc]) + bytes(sap or ()) + data
    return bytes([0x68, len(body), len(body), 0x68]) + body + bytes([sum(body) & 0xFF, 0x16])


def sd1(da, sa, fc):
    return bytes([0x10, da, sa, fc, da + sa + fc & 0xFF, 0x16])


def size_of(data):
    """Octets of the frame that begins so; 0 while that is open, None where nothing begins so."""
    if not data:
        return 0
    if data[0] in (0x10, 0xA2, 0xDC, 0xE5):
        return {0x10: 6, 0xA2: 14, 0xDC: 3, 0xE5: 1}[data[0]]
    if data[0] != 0x68:
        return None
    if len(data) < 4:
        return 0
    return data[1] + 6 if data[1] == data[2] and data[3] == 0x68 and 4 <= data[1] <= 249 else None


def is_whole(frame):
    """What a receiver without parity cannot tell from a good frame."""
    if not frame or size_of(frame) != len(frame):
        return False
    if frame[0] in (0xDC, 0xE5):
        return True
    body = frame[4:-2] if frame[0] == 0x68 else frame[1:-2]
    return frame[-1] == 0x16 and sum(body) & 0xFF == frame[-2]


class Port:
    def __init__(self, path):
        self.fd = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.fd)
        self.kept = b""

    def drain(self, quiet=0.0):
        """Throws away what comes until nothing has come for `quiet` seconds."""
        self.kept = b""
        while select.select([self.fd], [], [], quiet)[0]:
            os.read(self.fd, 4096)

    def write(self, data):
        while data:
            try:
                data = data[os.write(self.fd, data):]
            except BlockingIOError:
                select.select([], [self.fd], [], 1)

    def frame(self, seconds=SLOT):
        """The next frame; None when none is whole in time. What begins no frame ends the waiting."""
        end = time.monotonic() + seconds
        while True:
            size = size_of(self.kept)
            if size is None:
                self.drain(0.005)
                return None
            if size and len(self.kept) >= size:
                frame, self.kept = self.kept[:size], self.kept[size:]
                return frame if is_whole(frame) else None
            left = max(0.0, end - time.monotonic())  # what came while this program slept counts
            if not select.select([self.fd], [], [], left)[0]:
                return None
            self.kept += os.read(self.fd, 4096)


class Wire:
    """The port, and what damages frames on it."""

    def __init__(self, port, rng):
        self.port, self.rng, self.share = port, rng, 0.0
        self.count = collections.Counter()
        self.accepted = []      # damaged requests that are whole frames all the same: a wire has parity against them
        self.accepted_at = 0.0
        self.late = False       # a good frame is not answered yet

    def damage(self, frame):
        kind = self.rng.choice(("bit", "bits", "cut", "more", "lost"))
        out = bytearray(frame)
        if kind == "bit":
            out[self.rng.randrange(len(out))] ^= 1 << self.rng.randrange(8)
        elif kind == "bits":
            for _ in range(self.rng.randrange(2, 5)):
                out[self.rng.randrange(len(out))] ^= 1 << self.rng.randrange(8)
        elif kind == "cut":
            out = out[:self.rng.randrange(len(out))]
        elif kind == "more":
            at = self.rng.randrange(1, len(out))
            out[at:at] = self.rng.randbytes(self.rng.randrange(1, 9))
        else:
            out = bytearray()
        return bytes(out)

    def ask(self, frame, seconds=SLOT):
        if self.port.kept or select.select([self.port.fd], [], [], 0)[0]:
            self.count["octets nobody asked for"] += 1
            self.port.drain(0.002)
        self.count["frames out"] += 1
        damaged = False
        if self.share and self.rng.random() < self.share:
            damaged, sent = True, self.damage(frame)
            if sent == frame:
                damaged = False
            else:
                self.count["damaged out"] += 1
                if is_whole(sent):
                    self.count["damaged out, whole for a line without parity"] += 1
                    self.accepted.append(sent)
                    self.accepted_at = time.monotonic()
            self.port.write(sent)
        else:
            self.port.write(frame)
        answer = self.port.frame(seconds)
        if answer is None:
            self.late |= not damaged
            return None
        if damaged and not self.late and not is_whole(sent):
            self.count["damaged out, answered"] += 1
        self.late = False
        if self.share and self.rng.random() < self.share:
            self.count["damaged in"] += 1
            hurt = self.damage(answer)
            return hurt if hurt == answer else None
        return answer


class Slave:
    """One slave as a master of class 1 sees it: Slave_Diag, Set_Prm, Chk_Cfg, Slave_Diag, Data_Exchange."""

    def __init__(self, wire, address):
        self.wire, self.address = wire, address
        self.fcb = None         # of the next request; None: a sequence begins
        self.exchanging = False
        self.number = self.settled = 0
        self.last_good = 0.0
        self.count = collections.Counter()
        self.why = []           # of restarts

    def control(self):
        if self.fcb is None:
            return 0x6D
        return 0x5D | (0x20 if self.fcb else 0)

    def request(self, data=b"", dsap=None):
        """The data of the answer, "" of a short acknowledgement; None without one, after the tries."""
        frame = sd2(self.address, MASTER, self.control(), data, (dsap, SAP_MASTER) if dsap else None)
        for attempt in range(TRIES):
            answer = self.wire.ask(frame)
            if answer is not None and self.is_mine(answer, dsap):
                if attempt:
                    self.count["tried again"] += 1
                    self.wire.port.drain(0.02)  # a late answer to the try before
                self.fcb = False if self.fcb is None else not self.fcb
                self.last_good = time.monotonic()
                return answer
            if answer is not None:
                self.count["answers of others"] += 1
            self.wire.port.drain(0.005)
        self.fcb = None
        return None

    def is_mine(self, answer, dsap):
        if answer == b"\xE5":
            return True
        if answer[0] == 0x10:
            return answer[1:3] == bytes([MASTER, self.address])
        if answer[0] != 0x68 or answer[4] & 0x7F != MASTER or answer[5] & 0x7F != self.address:
            return False
        return dsap is None or answer[7:9] == bytes([SAP_MASTER, dsap])

    def diagnosis(self):
        answer = self.request(dsap=DIAG)
        return answer[9:-2] if answer is not None and answer[0] == 0x68 else None

    def start(self):
        """True when data exchange may begin."""
        self.fcb = None
        if self.diagnosis() is None:
            return False
        factor = round(WATCHDOG / 0.01)
        prm = bytes([0xB8, factor, 1, 11]) + IDENT[self.address].to_bytes(2, "big") + b"\0"
        if self.request(prm, PRM) != b"\xE5" or self.request(b"\xF3\xF2", CFG) != b"\xE5":
            return False
        diag = self.diagnosis()
        self.exchanging = diag is not None and diag[0] & 0x47 == 0 and diag[1] & 1 == 0 and diag[3] == MASTER
        self.settled = 0
        return self.exchanging

    def exchange(self, speed=SPEED):
        """One exchange; the parameter channel, without a service, mirrors its octets: a number that is never the same."""
        self.number += 1
        channel = b"\0\0\0\0" + self.number.to_bytes(4, "big")
        before = self.last_good
        answer = self.request(channel + (6).to_bytes(2, "big") + speed.to_bytes(2, "big") + b"\0\0")
        if answer is None or answer[0] != 0x68:
            self.exchanging = False
            self.count["restarts"] += 1
            gap = (time.monotonic() if answer is None else self.last_good) - before
            self.why.append(("no answer" if answer is None else f"refused with {answer[3]:02X}", round(1000 * gap)))
            return
        self.count["exchanges"] += 1
        data = answer[7:-2]
        if len(data) != 14 or data[:8] != channel or answer[6] & 0x0F not in (8, 10):
            self.count["wrong"] += 1
            print("wrong", self.address, self.number, answer.hex(" "), flush=True)
            return
        actual = int.from_bytes(data[10:12], "big", signed=True)
        self.settled = self.settled + 1 if actual == speed else 0
        if self.settled == 0 and self.count["settled"]:
            needs_parity = time.monotonic() - self.wire.accepted_at < 2
            self.count["speed elsewhere" + (", by a frame that needs parity" if needs_parity else "")] += 1
        if self.settled > 20 and not self.count["settled"]:
            self.count["settled"] = 1


def restart(slave):
    """Without an answer the slave may be looking for the rate; it does after its watchdog, too."""
    slave.count["settled"] = 0  # the axis comes from a stop
    if not slave.start():
        slave.count["starts without success"] += 1
        tell_rate(slave.wire.port)


def exchange(slaves, count, report=0, seconds=1e9):
    begin = time.monotonic()
    worst = 0.0
    for done in range(count // len(slaves)):
        if time.monotonic() - begin > seconds:
            count = done * len(slaves)
            break
        for slave in slaves:
            if not slave.exchanging:
                restart(slave)
                continue
            before = time.monotonic()
            slave.exchange()
            worst = max(worst, time.monotonic() - before)
        if report and (done + 1) % report == 0:
            print(f"{time.monotonic() - begin:.0f} s", {s.address: dict(s.count) for s in slaves}, flush=True)
    seconds = time.monotonic() - begin
    print(f"{count} turns in {seconds:.1f} s, {1000 * seconds / count:.2f} ms each, the slowest {1000 * worst:.0f} ms")
    for slave in slaves:
        print(slave.address, dict(slave.count), slave.why)
    print(dict(slaves[0].wire.count))


def tell_rate(port):
    """The slaves find the rate by what they hear; nobody has the address 125."""
    for _ in range(20):
        port.write(sd1(125, MASTER, 0x49))
        time.sleep(0.01)
    port.drain(0.1)


def careless(port, slaves, rng, count):
    """What no master may send. The slaves answer only what they must, and their axes stand."""
    others = 0
    for n in range(count):
        slave = rng.choice(slaves).address
        good = sd2(slave, 3, 0x6D, b"", (DIAG, SAP_MASTER))
        things = {
            "garbage": lambda: rng.randbytes(rng.randrange(1, 300)),
            "wrong FCS": lambda: good[:-2] + bytes([good[-2] + rng.randrange(1, 256) & 0xFF]) + good[-1:],
            "half": lambda: good[:rng.randrange(1, len(good))],
            "too long": lambda: b"\x68\xFF\xFF\x68" + rng.randbytes(261),
            "LE differs": lambda: b"\x68\x05\x06\x68" + good[4:],
            "no end": lambda: good[:-1] + b"\x17",
            "nobody": lambda: sd2(rng.randrange(10, 126), 3, 0x6D, rng.randbytes(14)),
            "unparameterised": lambda: sd2(slave, 3, 0x6D, rng.randbytes(rng.randrange(1, 245))),
            "access point": lambda: sd2(slave, 3, 0x6D, rng.randbytes(rng.randrange(0, 240)),
                                        (rng.choice([n for n in range(64) if n not in (60, 59)]), rng.randrange(64))),
            "Set_Prm": lambda: sd2(slave, 3, 0x6D, rng.randbytes(rng.choice([0, 1, 6, 8, 40, 244])), (PRM, SAP_MASTER)),
            "Chk_Cfg": lambda: sd2(slave, 3, 0x6D, rng.randbytes(rng.randrange(0, 244)), (CFG, SAP_MASTER)),
            "Global_Control": lambda: sd2(127, 3, 0x46, rng.randbytes(2), (GLOBAL, SAP_MASTER)),
            "token": lambda: bytes([0xDC, rng.randrange(256), rng.randrange(256)]),
            "function": lambda: sd1(slave, 3, 0x40 | rng.randrange(64)),
            "answer": lambda: sd2(slave, 3, 0x08, rng.randbytes(14)),
            "from itself": lambda: sd2(slave, slave, 0x6D, rng.randbytes(14)),
            "broadcast": lambda: sd2(127, 3, 0x6D, rng.randbytes(14)),
            "SD3": lambda: b"\xA2" + rng.randbytes(13),
        }
        port.write(things[list(things)[n % len(things)]]())
        port.drain(0.012)       # longer than the gap a port may have within a frame
        if n % 8 == 7:
            for each in slaves:
                each.fcb = None
                diag = each.diagnosis()
                if diag is None or diag[1] & 1 == 0 or diag[3] != 0xFF:
                    others += 1
                    print("careless:", each.address, diag and diag.hex(" "), n, flush=True)
    return others


def master(process, path, exchanges, damaged, carelessness):
    for _ in range(500):
        if os.path.lexists(path) or process.poll() is not None:
            break
        time.sleep(0.02)
    port = Port(path)
    rng = random.Random(31)
    wire = Wire(port, rng)
    slaves = [Slave(wire, address) for address in SLAVES]
    tell_rate(port)
    check("both slaves answer Slave_Diag", [s.diagnosis() for s in slaves],
          [bytes([2, 5, 0, 0xFF]) + IDENT[s.address].to_bytes(2, "big") for s in slaves])
    check("both slaves start", [s.start() for s in slaves], [True, True])

    exchange(slaves, exchanges, max(exchanges // 40, 1000), float(os.environ.get("SECONDS", 1e9)))
    check("no exchange is wrong", sum(s.count["wrong"] for s in slaves), 0)
    check("the axis stays at its speed", sum(s.count["speed elsewhere"] for s in slaves), 0)
    check("both axes have come to it", [s.count["settled"] for s in slaves], [1, 1])
    print("restarts:", {s.address: s.why for s in slaves})
    restarts = [reason for slave in slaves for reason in slave.why]
    clean = {s.address: dict(s.count) for s in slaves}

    if damaged:
        wire.share = 0.01
        exchange(slaves, damaged, damaged // 10)
        wire.share = 0.0
        check("noise: no exchange is wrong", sum(s.count["wrong"] for s in slaves), 0)
        check("noise: the axis never acts on a damaged frame", sum(s.count["speed elsewhere"] for s in slaves), 0)
        check("noise: no damaged frame is answered but those that need parity", wire.count["damaged out, answered"], 0)
        print("whole without parity:", [frame.hex(" ") for frame in wire.accepted])
        exchange(slaves, 200)
        check("noise: data exchange recovers", [s.exchanging for s in slaves], [True, True])

    if carelessness:
        time.sleep(WATCHDOG + 0.3)
        tell_rate(port)
        check("careless: the slaves wait, locked by nobody", careless(port, slaves, rng, carelessness), 0)
        for slave in slaves:
            restart(slave)
        check("careless: both slaves start again", [s.exchanging for s in slaves], [True, True])
        before = sum(s.count["exchanges"] for s in slaves)
        exchange(slaves, 400)
        check("careless: data exchange goes on", sum(s.count["exchanges"] for s in slaves) - before > 300, True)
    print("clean:", clean)
    return restarts


def unexplained(restarts, worst):
    """A slave may refuse only behind its watchdog. Without an answer in three slot times ipos, or this program, has not
    been executed for as long: then the run tells of ticks that late."""
    return [(why, gap) for why, gap in restarts
            if gap < 1000 * (TRIES * SLOT if why == "no answer" else WATCHDOG) or (why == "no answer" and worst < 1000 * SLOT)]


def main():
    ipos, plant, path, *rest = sys.argv[1:]
    exchanges, damaged, carelessness = (list(map(int, rest[:3])) + [0, 0])[:3]
    run = [ipos, "run", plant, "--realtime", "--for", "24h", "--why"] + (["--serial-log", rest[3]] if len(rest) > 3 else [])
    messages = open(path + ".messages", "w+")
    process = subprocess.Popen(run, stdout=subprocess.DEVNULL, stderr=messages, text=True)
    try:
        restarts = master(process, path, exchanges, damaged, carelessness)
    finally:
        process.terminate()
        process.wait(20)
    messages.seek(0)
    text = messages.read()
    messages.close()
    os.unlink(path + ".messages")
    worst = re.search(r"the worst ([\d.]+) ms", text)
    check("every restart has its reason", unexplained(restarts, float(worst[1]) if worst else 0.0), [])
    check("the run says nothing of an error", re.findall(r"(?m)^.*error.*$", text), [])
    print(text)
    print("end")


main()
