"""noise.py IPOS [SECONDS [FLOOD]]: noise at the pseudo-terminals of a plant that runs in real time, on an RS-485 line of
9600 baud and on an slcan adapter of 115200, at the rates of such lines; with FLOOD as fast as they take it. Virtual time
has to stay with the clock, Ctrl-C has to be heard, memory and messages have to stay bounded. A host that is busy with
other things makes a try fail, too, so there are three."""
import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time

from checks import check

PLANT = """
[[bus]]
name = "line1"
kind = "rs485"
port = "pty:{0}/line1"

[[bus]]
name = "sbus"
kind = "can"
port = "slcan:pty:{0}/can1"

[[station]]
name = "unit1"
unit = "md60a"
sbus = "sbus"
rs485 = "line1"
"""
CHARACTERS_A_SECOND = {"line1": 9600 / 11, "can1": 115200 / 10}
KINDS = 40  # lines of messages there may be, whatever comes


def serial_noise(rng, size):
    """Any bytes, and now and then what begins like a request."""
    return b"".join(b"\x02\x01\x86" if rng.random() < 0.02 else rng.randbytes(1) for _ in range(size))[:size]


def slcan_noise(rng, size):
    """Lines cut off, bytes turned over, escape sequences, no ends; each line another one."""
    out = b""
    while len(out) < size:
        line = b"t%03X8%016X" % (rng.randrange(2048), rng.getrandbits(64))
        kind = rng.randrange(6)
        if kind == 0:
            line = line[:rng.randrange(1, len(line))]
        elif kind == 1:
            line = line[:3] + rng.randbytes(2) + line[5:]
        elif kind == 2:
            line = b"t\x1b[2J\x1b]0;%d" % rng.getrandbits(32)
        elif kind == 3:
            line = rng.randbytes(60)
        elif kind == 4:
            line = b"T%X!" % rng.getrandbits(40)
        out += line + b"\r"
    return out[:size]


def resident_kb(pid):
    with open(f"/proc/{pid}/status") as status:
        return int(re.search(r"VmRSS:\s+(\d+)", status.read())[1])


def attempt(ipos, seconds, flood):
    rng = random.Random(1053)
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/plant.toml", "w") as plant:
            plant.write(PLANT.format(folder))
        with open(f"{folder}/messages", "wb") as messages:
            run = subprocess.Popen([ipos, "run", f"{folder}/plant.toml", "--realtime", "--for", "24h"],
                                   stdout=subprocess.DEVNULL, stderr=messages)
        while not (os.path.lexists(f"{folder}/line1") and os.path.lexists(f"{folder}/can1")):
            if run.poll() is not None:
                sys.exit(open(f"{folder}/messages").read())
            time.sleep(0.01)
        peers = {name: os.open(f"{folder}/{name}", os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK) for name in CHARACTERS_A_SECOND}
        os.write(peers["can1"], b"C\rS6\rO\r")
        time.sleep(0.1)
        ready = {"line1": [serial_noise(rng, 4096) for _ in range(50)], "can1": [slcan_noise(rng, 4096) for _ in range(50)]}
        begin = time.monotonic()
        written = dict.fromkeys(peers, 0)
        first_kb = None
        while (now := time.monotonic() - begin) < seconds:
            for name, fd in peers.items():
                try:
                    os.read(fd, 65536)  # the answers of the adapter
                except BlockingIOError:
                    pass
                due = 4096 if flood else int(now * CHARACTERS_A_SECOND[name]) - written[name]
                try:
                    if due > 0:
                        written[name] += os.write(fd, rng.choice(ready[name])[:due])
                except BlockingIOError:
                    written[name] += 0 if flood else due  # a line has no room for what came too fast
            if first_kb is None and now > min(10, seconds / 2):
                first_kb = resident_kb(run.pid)
            if not flood:
                time.sleep(0.002)
        last_kb = resident_kb(run.pid)
        stopped = time.monotonic()
        run.send_signal(signal.SIGINT)
        while run.poll() is None and time.monotonic() - stopped < 60:
            for name, fd in peers.items():  # the noise goes on
                try:
                    os.write(fd, rng.choice(ready[name])[:100])
                except OSError:
                    pass
            time.sleep(0.002)
        took = time.monotonic() - stopped
        run.kill()
        with open(f"{folder}/messages", "rb") as messages:
            text = messages.read()
    real = re.search(rb"real time: ([\d.]+) s; .*?the worst ([\d.]+) ms; ([\d.]+) ms behind", text)
    return {
        "exit code": run.wait(),
        "virtual s": float(real[1]) if real else None,
        "behind ms": float(real[3]) if real else 1e9,
        "worst tick ms": float(real[2]) if real else None,
        "stop s": round(took, 3),
        "kB at first": first_kb,
        "kB at last": last_kb,
        "written": written,
        "messages": text.count(b"\n"),
        "escapes": text.count(b"\x1b"),
    }, text


ipos = sys.argv[1]
seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 4
for tries in range(3):
    figures, text = attempt(ipos, seconds, len(sys.argv) > 3)
    print(figures)
    if figures["behind ms"] < 50 and figures["stop s"] < 1:
        break
check("ends by Ctrl-C", figures["exit code"], 130)
check("virtual time is within 50 ms of the clock", figures["behind ms"] < 50, True)
check("Ctrl-C is heard within a second", figures["stop s"] < 1, True)
check("memory does not grow", figures["kB at last"] - figures["kB at first"] < 1024, True)
check("messages are counted, not repeated", figures["messages"] < KINDS, True)
check("no byte of a peer reaches the terminal as it is", figures["escapes"], 0)
print(text.decode(errors="replace"))
print("end")
