"""`ipos serve` with real sockets: who is let in, what is too much, and that it ends well.

A WebSocket client of a hundred lines, so that nothing is needed but Python.
"""
import base64
import json
import os
import pathlib
import random
import re
import select
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import tty
import unittest

IPOS = sys.argv.pop(1)
PATIENCE = 100  # s for anything that must come; a loaded machine needs more than an idle one
STATE = tempfile.TemporaryDirectory()  # tokens of these tests are no business of the user's
os.environ["XDG_STATE_HOME"] = STATE.name
PLANT = """
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "saw"
unit = "md60a"
program = "SAW.IPC"
sbus = "sbus"
"""
PROGRAM = "long lCount;\nmain()\n{\n  while (1) { lCount++; _Wait(1); }\n}\n"


class Client:
    """One WebSocket."""

    def __init__(self, port, path, headers=(), host=None, origin=None):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
        key = base64.b64encode(os.urandom(16)).decode()
        lines = [f"GET {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}", "Upgrade: websocket",
                 "Connection: Upgrade", f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13", *headers]
        if origin:
            lines.append(f"Origin: {origin}")
        self.socket.sendall(("\r\n".join(lines) + "\r\n\r\n").encode())
        self.rest = b""
        while b"\r\n\r\n" not in self.rest:
            more = self.socket.recv(65536)
            if not more:
                break
            self.rest += more
        head, _, self.rest = self.rest.partition(b"\r\n\r\n")
        self.status = int(head.split()[1])
        self.id = 0
        self.events = []

    def take(self, count):
        while len(self.rest) < count:
            more = self.socket.recv(65536)
            if not more:
                raise EOFError
            self.rest += more
        taken, self.rest = self.rest[:count], self.rest[count:]
        return taken

    def receive(self):
        """The next message: (opcode, bytes)."""
        first, second = self.take(2)
        length = second & 127
        if length == 126:
            length = struct.unpack(">H", self.take(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", self.take(8))[0]
        data = self.take(length)
        if first & 15 == 9:  # a ping wants its pong, else the server thinks that nobody is there
            self.send(data, opcode=10)
        return first & 15, data

    def send(self, data, opcode=1):
        mask = os.urandom(4)
        length = len(data)
        head = bytes([128 | opcode])
        if length < 126:
            head += bytes([128 | length])
        elif length < 65536:
            head += bytes([128 | 126]) + struct.pack(">H", length)
        else:
            head += bytes([128 | 127]) + struct.pack(">Q", length)
        masked = bytes(b ^ mask[n & 3] for n, b in enumerate(data))
        self.socket.sendall(head + mask + masked)

    def ask(self, **message):
        """The reply; events that come before it are kept."""
        self.id += 1
        message["id"] = self.id
        self.send(json.dumps(message).encode())
        while True:
            opcode, data = self.receive()
            if opcode == 8:
                raise EOFError
            if opcode != 1:
                continue
            answer = json.loads(data)
            if answer.get("re") == self.id:
                return answer
            self.events.append(answer)

    def wait_for(self, event, wanted=lambda _: True):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            opcode, data = self.receive()
            answer = json.loads(data) if opcode == 1 else {}
            if answer.get("event") == event and wanted(answer):
                return answer
        raise TimeoutError(f"no such event: {event}")

    def close(self):
        self.socket.close()


def processes_with(word):
    """Numbers of the processes that have the word in their command."""
    found = []
    for line in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if word.encode() in line.read_bytes():
                found.append(int(line.parent.name))
        except OSError:
            pass
    return found


class Serving(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        folder = pathlib.Path(self.folder.name)
        (folder / "plant.toml").write_text(PLANT)
        (folder / "SAW.IPC").write_text(PROGRAM)
        self.ipos = subprocess.Popen([IPOS, "serve", str(folder / "plant.toml")], stdout=subprocess.PIPE,
                                     stderr=subprocess.PIPE, text=True)
        self.address = self.ipos.stdout.readline().strip()
        match = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=([0-9a-f]{32})", self.address)
        self.assertTrue(match, self.address)
        self.port, self.token = int(match[1]), match[2]

    def tearDown(self):
        if self.ipos.poll() is None:
            self.ipos.kill()
        self.ipos.wait()
        self.ipos.stdout.close()
        self.ipos.stderr.close()
        self.folder.cleanup()

    def connect(self, **more):
        client = Client(self.port, f"/ws?token={self.token}", **more)
        self.addCleanup(client.close)
        return client

    def http(self, request):
        with socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE) as connection:
            try:
                connection.sendall(request)
            except ConnectionError:
                pass
            answer = b""
            try:
                while more := connection.recv(65536):
                    answer += more
            except ConnectionError:
                pass
        return answer

    def status(self, target, host=None, method="GET", more=""):
        host = host or f"127.0.0.1:{self.port}"
        answer = self.http(f"{method} {target} HTTP/1.1\r\nHost: {host}\r\n{more}\r\n".encode())
        return int(answer.split()[1])

    def test_the_page_needs_the_token_and_our_host(self):
        page = self.http(f"GET /?token={self.token} HTTP/1.1\r\nHost: localhost:{self.port}\r\n\r\n".encode())
        self.assertTrue(page.startswith(b"HTTP/1.1 200"))
        self.assertIn(b"default-src 'none'", page)
        self.assertIn(b"<!doctype html>", page.lower())
        self.assertEqual(self.status("/"), 401)
        self.assertEqual(self.status("/?token=0"), 401)
        self.assertEqual(self.status(f"/?token={self.token}0"), 401)
        self.assertEqual(self.status(f"/?token={self.token}", host="evil.example"), 403)
        self.assertEqual(self.status(f"/?token={self.token}", host=f"evil.example:{self.port}"), 403)
        self.assertEqual(self.status(f"/?token={self.token}", more="Origin: http://evil.example\r\n"), 403)
        self.assertEqual(self.status("/favicon.ico"), 404)
        self.assertEqual(self.status(f"/?token={self.token}", method="POST"), 405)
        self.assertEqual(self.status(f"/ws?token={self.token}"), 426)

    def test_the_socket_needs_them_too(self):
        ours = f"http://127.0.0.1:{self.port}"
        self.assertEqual(self.connect(origin=ours).status, 101)
        self.assertEqual(self.connect(origin="http://evil.example").status, 403)
        self.assertEqual(self.connect(host="evil.example").status, 403)
        for path in ("/ws", "/ws?token=", "/ws?token=" + "0" * 32):
            client = Client(self.port, path)
            client.close()
            self.assertEqual(client.status, 401)

    def test_an_origin_is_ours_as_a_whole(self):
        """Another port or name that begins or ends like ours is another page."""
        ours = f"http://127.0.0.1:{self.port}"
        for origin in (ours + "0", ours + ".evil.example", ours + "/", ours[:-1], "http://127.0.0.1", "https" + ours[4:],
                       "http://evil.example/" + ours, ours.upper(), "null", ""):
            self.assertEqual(self.status(f"/?token={self.token}", more=f"Origin: {origin}\r\n"), 403, origin)
            if origin:
                self.assertEqual(self.connect(origin=origin).status, 403, origin)

    def test_silent_connections_keep_nobody_out(self):
        silent = [socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE) for _ in range(200)]
        for connection in silent:
            self.addCleanup(connection.close)
        begin = time.monotonic()
        self.assertTrue(self.connect().ask(do="plant")["ok"])
        self.assertLess(time.monotonic() - begin, 8, "they have 10 s for their request")
        self.assertEqual(self.status(f"/?token={self.token}"), 200)

    def test_too_much_is_refused(self):
        self.assertEqual(self.status(f"/?token={self.token}", more="X: " + "x" * 9000 + "\r\n"), 431)
        client = self.connect()
        # A text of the editor is taken up to 128 KiB.
        self.assertTrue(client.ask(do="plant", more="x" * 130_000)["ok"])
        client.send(b'"' + b"x" * 132_000 + b'"')
        with self.assertRaises((EOFError, ConnectionError)):
            while client.receive()[0] != 8:
                pass
            raise EOFError
        self.assertTrue(self.connect().ask(do="plant")["ok"])

    def test_eight_clients_and_no_more(self):
        clients = [self.connect() for _ in range(8)]
        self.assertEqual([client.status for client in clients], [101] * 8)
        self.assertEqual(self.connect().status, 503)
        clients[0].close()
        for _ in range(100):
            if self.connect().status == 101:
                return
            time.sleep(0.05)
        self.fail("a place that is free is not given")

    def test_ten_thousand_garbage_messages(self):
        client = self.connect()
        drop = random.Random(1)
        words = ["do", "id", "step", "ms", "topic", "subscribe", "watch", "names", "plant", "scope", "channels", "input"]
        client.socket.settimeout(60)
        replies = 0
        for n in range(10_000):
            if n % 3 == 0:
                data = bytes(drop.randrange(32, 127) for _ in range(drop.randrange(40)))
            elif n % 3 == 1:
                data = json.dumps({drop.choice(words): drop.choice([n, "x", None, [], {}, 1e300, True]) for _ in range(3)}).encode()
            else:
                data = b"[" * drop.randrange(200)
            client.send(data)
            while n - replies > 20:
                replies += "re" in json.loads(client.receive()[1])
        self.assertTrue(client.ask(do="plant")["ok"])
        other = self.connect()
        self.assertTrue(other.ask(do="step")["ok"])

    def test_a_click_and_time(self):
        one, two = self.connect(), self.connect()
        self.assertTrue(one.ask(do="input", station="saw", name="DI02", action="set", on=True)["ok"])
        two.ask(do="subscribe", topic="plant")
        self.assertEqual(two.wait_for("plant")["stations"]["saw"]["in"], 4)
        self.assertEqual(one.ask(do="step", ms=1000)["us"], 1_000_000)
        self.assertEqual(one.ask(do="back", ms=400)["us"], 600_000)
        self.assertEqual(two.ask(do="step")["us"], 601_000)
        self.assertEqual(one.ask(do="restart")["us"], 0)

    def test_back_in_time_by_snapshots_gives_the_same_run(self):
        client = self.connect()
        client.ask(do="scope", channels=["saw.lCount"])
        for _ in range(6):
            client.ask(do="step", ms=700)
            time.sleep(0.3)  # snapshots are a quarter of a second of the clock apart
        client.ask(do="set", name="saw.H300", value="5")
        self.assertEqual(client.ask(do="back", us=3_000_000)["us"], 3_000_000)
        client.ask(do="watch", names=["saw.H300", "saw.lCount"])
        client.ask(do="subscribe", topic="watch")
        values = client.wait_for("watch")["values"]
        self.assertEqual(values["saw.H300"]["value"], 0)
        first = values["saw.lCount"]["value"]
        rows = client.ask(do="scope.csv")["csv"].splitlines()
        self.assertEqual(rows[-1], f"3000,{first}")
        self.assertEqual(len(rows), 3001)
        client.ask(do="step", ms=1200)
        self.assertEqual(client.ask(do="back", us=3_000_000)["us"], 3_000_000)
        client.ask(do="subscribe", topic="watch")
        self.assertEqual(client.wait_for("watch")["values"]["saw.lCount"]["value"], first)

    def test_every_moment_is_the_same_by_snapshots(self):
        """Back and on at random: what is watched, recorded and heard, and the scope's trigger, are those of the first time."""
        client = self.connect()
        client.ask(do="scope", channels=["saw.lCount"])
        client.ask(do="scope.arm", single=False)
        client.ask(do="watch", names=["saw.lCount", "saw.H300", "saw.DI02"])
        client.ask(do="subscribe", topic="watch")

        def seen():
            client.ask(do="subscribe", topic="watch")
            values = client.wait_for("watch")["values"]
            rows = client.ask(do="scope.csv")["csv"]
            frames = client.ask(do="bus.trace", limit=1000)["frames"]
            scope = client.ask(do="scope")
            return ({name: value["value"] for name, value in values.items()}, hash(rows), frames, scope["trigger_us"])

        moments = {}
        for n in range(12):
            if n == 3:
                client.ask(do="input", station="saw", name="DI02", action="set", on=True)
            if n == 5:
                client.ask(do="bus.send", bus="sbus", identifier=523, data="0102")
                client.ask(do="set", name="saw.H300", value="5")
            if n == 7:
                client.ask(do="scope.trigger")
            moments[n * 300] = seen()
            client.ask(do="step", ms=300)
            time.sleep(0.06)  # snapshots are a twentieth of a second of the clock apart
        draw = random.Random(7)
        for _ in range(40):
            ms = draw.choice(list(moments))
            self.assertEqual(client.ask(do="go", us=ms * 1000)["us"], ms * 1000)
            self.assertEqual(seen(), moments[ms], ms)
        # A dragged slider: many orders, the last one counts.
        for n in range(200):
            client.id += 1
            client.send(json.dumps({"id": client.id, "do": "go", "us": draw.randrange(3600) * 1000}).encode())
        self.assertEqual(client.ask(do="go", us=1_800_000)["us"], 1_800_000)
        self.assertEqual(seen()[:3], moments[1800][:3])
        client.ask(do="step", ms=1)
        self.assertIn("error", client.ask(do="go", us=3_000_000))
        self.assertEqual(client.ask(do="go", us=900_000)["us"], 900_000)
        client.ask(do="step", ms=1500)
        values = seen()[0]
        self.assertEqual((values["saw.DI02"], values["saw.H300"]), (1, 0))  # of the clicks only that before 1.8 s stays
        self.ipos.send_signal(signal.SIGINT)
        self.ipos.wait(PATIENCE)
        end = time.monotonic() + PATIENCE
        while processes_with(self.folder.name) and time.monotonic() < end:
            time.sleep(0.1)
        self.assertEqual(processes_with(self.folder.name), [], "copies are left behind")

    def test_it_runs_in_step_with_the_clock(self):
        client = self.connect()
        client.ask(do="run", speed=1)
        begin = time.monotonic()
        event = client.wait_for("time", lambda event: event["us"] >= 1_000_000)
        self.assertGreater(time.monotonic() - begin, 0.9)
        self.assertTrue(event["running"])
        self.assertTrue(client.ask(do="pause")["ok"])
        fast = client.ask(do="run", speed=0)
        self.assertTrue(fast["ok"])
        client.wait_for("time", lambda event: event["us"] >= 5_000_000)

    def test_a_client_that_does_not_read_holds_nobody_up(self):
        lazy, client = self.connect(), self.connect()
        for topic in ("plant", "scope", "bus", "journal"):
            lazy.ask(do="subscribe", topic=topic, rate=60)
        client.ask(do="run", speed=0)
        client.wait_for("time", lambda event: event["us"] >= 2_000_000)
        begin = time.monotonic()
        client.wait_for("time", lambda event: event["us"] >= 4_000_000)
        self.assertLess(time.monotonic() - begin, 20)

    def test_a_killed_client_is_forgotten(self):
        client = self.connect()
        client.ask(do="run")
        client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        client.close()
        self.assertTrue(self.connect().ask(do="plant")["ok"])

    def test_a_channel_added_later_is_there_in_every_copy(self):
        """By way of snapshots: chosen late, looked at after going back before that, and after going on."""
        client = self.connect()
        client.ask(do="scope", channels=["saw.lCount"])
        for _ in range(4):
            client.ask(do="step", ms=700)
            time.sleep(0.3)  # snapshots are a quarter of a second of the clock apart
        client.ask(do="set", name="saw.H300", value="7")
        client.ask(do="step", ms=200)
        client.ask(do="scope", channels=["saw.lCount", "saw.H300", "saw.speed"])
        rows = client.ask(do="scope.csv")["csv"].splitlines()
        self.assertEqual(len(rows), 3001)
        self.assertEqual([row.split(",")[2] for row in rows[2799:2803]], ["0", "0", "7", "7"])
        counts = [int(row.split(",")[1]) for row in rows[1:]]
        client.ask(do="back", us=1_500_000)
        rows = client.ask(do="scope.csv")["csv"].splitlines()
        self.assertEqual(len(rows), 1501)
        self.assertTrue(all(row.count(",") == 3 and ",," not in row for row in rows))
        client.ask(do="step", ms=1500)
        rows = client.ask(do="scope.csv")["csv"].splitlines()
        self.assertEqual([int(row.split(",")[1]) for row in rows[1:]], counts)
        self.assertEqual(rows[-1].split(",")[2], "0")  # what was written later is undone

    def test_a_second_start_has_the_address_of_the_first(self):
        """Without --port the free one of the time before; the token in any case. Nobody else may read it."""
        files = list(pathlib.Path(os.environ["XDG_STATE_HOME"]).rglob("*"))
        self.assertTrue([file for file in files if file.is_file() and self.token in file.read_text()])
        for file in files:
            self.assertEqual(file.stat().st_mode & 0o77, 0, file)
        plant = str(pathlib.Path(self.folder.name) / "plant.toml")

        def start(*more):
            other = subprocess.Popen([IPOS, "serve", plant, *more], stdout=subprocess.PIPE, text=True)
            self.addCleanup(other.stdout.close)
            self.addCleanup(other.wait)
            self.addCleanup(other.kill)
            return other, other.stdout.readline().strip()

        beside, address = start()  # its port is taken, so it has another one
        self.assertTrue(address.endswith(f"?token={self.token}"))
        self.assertNotEqual(address, self.address)
        beside.send_signal(signal.SIGINT)
        beside.wait()
        self.ipos.kill()  # whatever ended it
        self.ipos.wait()
        again, address = start("--port", str(self.port))
        self.assertEqual(address, self.address)
        client = self.connect()
        self.assertTrue(client.ask(do="plant")["ok"])
        client.close()
        again.send_signal(signal.SIGINT)
        again.wait()
        self.assertEqual(start()[1], self.address)

    def test_settings_are_kept(self):
        one = self.connect()
        self.assertEqual(one.ask(do="settings")["settings"], {})
        self.assertTrue(one.ask(do="settings.set", name="keys", value=False)["ok"])
        one.ask(do="step", ms=500)
        one.ask(do="restart")
        self.assertEqual(self.connect().ask(do="settings")["settings"], {"keys": False})

    def test_ctrl_c_ends_it(self):
        client = self.connect()
        # A browser opens a connection before it knows what it wants to ask.
        silent = socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE)
        self.addCleanup(silent.close)
        client.ask(do="run")
        self.ipos.send_signal(signal.SIGINT)
        self.assertEqual(self.ipos.wait(timeout=PATIENCE), 0)
        with self.assertRaises((EOFError, ConnectionError)):
            while client.receive()[0] != 8:
                pass
            raise EOFError
        self.assertEqual(self.ipos.stderr.read(), "")


def memory_of_group(process):
    """MB of a process that leads its group and of all others in it, shared pages counted once."""
    total = 0
    for entry in pathlib.Path("/proc").iterdir():
        try:
            if entry.name.isdigit() and os.getpgid(int(entry.name)) == process.pid:
                for line in (entry / "smaps_rollup").read_text().splitlines():
                    if line.startswith("Pss:"):
                        total += int(line.split()[1]) / 1024
        except OSError:
            pass
    return total


class Memory(unittest.TestCase):
    """The recordings of scope and trace are there once, whatever number of copies for going back there is."""

    BOUND = 150  # MB

    def run_until(self, plant, seconds):
        """As fast as it goes to that time of the plant; the most memory on the way, at ten looks."""
        ipos = subprocess.Popen([IPOS, "serve", str(plant)], stdout=subprocess.PIPE, text=True, start_new_session=True)
        self.addCleanup(ipos.stdout.close)
        self.addCleanup(ipos.wait)
        self.addCleanup(ipos.terminate)
        match = re.search(r":(\d+)/\?token=(\w+)", ipos.stdout.readline())
        client = Client(int(match[1]), f"/ws?token={match[2]}")
        self.addCleanup(client.close)
        client.socket.settimeout(120)
        for topic in ("plant", "bus", "trace", "journal"):
            client.ask(do="subscribe", topic=topic, rate=5)
        client.ask(do="run", speed=0)
        most = 0
        for part in range(1, 11):
            while True:
                opcode, data = client.receive()
                if opcode == 1 and b'"event":"time"' in data and json.loads(data)["us"] >= seconds * 100_000 * part:
                    break
            most = max(most, memory_of_group(ipos))
        return most, client

    def test_a_recording_that_has_turned_over(self):
        most, client = self.run_until(pathlib.Path(__file__).parents[2] / "examples/isync/isync.toml", 2_500)
        self.assertLess(most, self.BOUND)
        # And the copies still lead back, with what was recorded.
        client.ask(do="pause")
        us = client.ask(do="step")["us"]
        self.assertEqual(client.ask(do="back", us=us - 100_000_000)["us"], us - 100_000_000)
        rows = client.ask(do="scope.csv", from_us=us - 100_010_000)["csv"].splitlines()
        self.assertEqual(rows[-1].split(",")[0], str((us - 100_000_000) // 1000))
        self.assertEqual(len(rows), 12)

    def test_many_drives(self):
        sys.path.insert(0, str(pathlib.Path(__file__).parent))
        import figures

        with tempfile.TemporaryDirectory() as folder:
            most, _ = self.run_until(figures.write_plant(pathlib.Path(folder), 64), 120)
        self.assertLess(most, self.BOUND)


def client_of_device(test, line, *more):
    """`ipos serve --device` for a test, and a client of it."""
    ipos = subprocess.Popen([IPOS, "serve", "--device", line, "--address", "1", "--quiet", *more],
                            stdout=subprocess.PIPE, text=True)
    test.addCleanup(ipos.stdout.close)
    test.addCleanup(ipos.wait)
    test.addCleanup(ipos.terminate)
    match = re.search(r":(\d+)/\?token=(\w+)", ipos.stdout.readline())
    test.assertTrue(match)
    client = Client(int(match[1]), f"/ws?token={match[2]}")
    test.addCleanup(client.close)
    return client


def what_is_recorded(client):
    """The names of the channels, when the scope has recorded something; none after ten seconds."""
    for _ in range(100):
        scope = client.ask(do="scope")
        if scope["last_us"] > scope["first_us"]:
            return [channel["name"] for channel in scope["channels"]]
        time.sleep(0.1)
    return []


@unittest.skipUnless(os.path.exists("/dev/pts/ptmx"), "there is no /dev/pts: no pseudo-terminals here")
class RealDrive(unittest.TestCase):
    """A simulated drive at a pseudo-terminal, which is a real one for `ipos serve --device`."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        line = pathlib.Path(self.folder.name) / "line1"
        plant = pathlib.Path(self.folder.name) / "plant.toml"
        plant.write_text(f'''
[[bus]]
name = "line1"
kind = "rs485"
port = "pty:{line}"
[[station]]
name = "saw"
unit = "md60a"
rs485 = "line1"
[station.inputs]
DI00 = 1
DI01 = 1
DI03 = 1
[station.parameters]
P810 = 1
P870 = "CTRL. WORD 1"
P871 = "SPEED"
P100 = "RS-485"
P101 = "RS-485"
''')
        self.drive = subprocess.Popen([IPOS, "run", str(plant), "--realtime", "--for", "60s"], stdout=subprocess.DEVNULL,
                                      stderr=subprocess.DEVNULL)
        self.addCleanup(self.drive.wait)
        self.addCleanup(self.drive.kill)
        for _ in range(200):
            if line.exists():
                break
            time.sleep(0.05)
        self.line = str(line)

    def serve(self, *more):
        return client_of_device(self, self.line, *more)

    def test_it_only_reads_unless_told(self):
        client = self.serve()
        self.assertIn("--write", client.ask(do="arm", yes=True)["error"])
        self.assertIn("--write", client.ask(do="parameters.set", number="P130", value="3 s")["error"])
        self.assertIn("--write", client.ask(do="jog", direction="cw", rpm=100)["error"])
        client.ask(do="watch", names=["P130"])
        client.ask(do="subscribe", topic="watch")
        self.assertEqual(client.wait_for("watch")["values"]["unit1.P130"]["text"], "2.000 s")

    def test_the_scope_records_a_run_up(self):
        client = self.serve("--write")
        client.ask(do="arm", yes=True)
        self.assertEqual([one["name"] for one in client.ask(do="scope")["channels"]],
                         ["unit1.P000", "unit1.P004", "unit1.P008"])
        self.assertIn("P999", client.ask(do="scope", channels=["P999"])["error"])
        self.assertIn("level or edge", client.ask(do="scope", trigger={"kind": "fault"})["error"])
        set_up = client.ask(do="scope", channels=["P000"], pre=50, length_ms=1000,
                            trigger={"kind": "level", "signal": "P000", "value": 100})
        self.assertEqual((set_up["channels"][0]["name"], set_up["channels"][0]["unit"]), ("unit1.P000", "rpm"))
        client.ask(do="scope.arm", single=True)
        client.ask(do="subscribe", topic="scope")
        state = {}
        for _ in range(200):
            self.assertTrue(client.ask(do="jog", direction="cw", rpm=300)["ok"])
            for event in client.events:
                state = event if event.get("event") == "scope" else state
            client.events.clear()
            if state.get("state") == "done":
                break
            time.sleep(0.05)
        self.assertEqual(state.get("state"), "done", state)
        self.assertIn("unit1.P000 is", state["trigger_text"])
        rows = [row.split(",") for row in client.ask(do="scope.csv")["csv"].splitlines()]
        self.assertEqual(rows[0], ["time_ms", "unit1.P000 [rpm]"])
        milliseconds = [float(row[0]) for row in rows[1:]]
        self.assertEqual(milliseconds, [milliseconds[0] + n for n in range(len(milliseconds))])
        at_trigger = [float(row[1]) for row in rows[1:] if abs(float(row[0]) * 1000 - state["trigger_us"]) < 1]
        self.assertEqual(len(at_trigger), 1)
        self.assertGreaterEqual(at_trigger[0], 100)
        before = [float(row[1]) for row in rows[1:] if float(row[0]) * 1000 < state["trigger_us"] - 1]
        self.assertLess(before[-1], 100)

    def test_a_drive_that_is_silent_when_the_scope_begins_is_asked_again(self):
        client = self.serve()
        self.drive.send_signal(signal.SIGSTOP)
        self.assertTrue(client.ask(do="subscribe", topic="scope")["ok"])
        time.sleep(1)
        self.assertTrue(client.ask(do="plant")["ok"], "the server is there")
        scope = client.ask(do="scope")
        self.assertEqual(scope["last_us"], scope["first_us"], "nothing is recorded of a silent drive")
        self.drive.send_signal(signal.SIGCONT)
        self.assertTrue(what_is_recorded(client))

    # Reading P130, index 8470 = 2116h: MOVILINK on RS-485, 02 ADR TYP PDU BCC with TYP 86h (parameter channel, acyclic)
    # and the service 31h; its answer begins with 1D (1053 1610 p. 18-25). BCC is the exclusive or of all bytes before.
    def test_the_tab_bus_shows_questions_and_answers_and_sends_when_confirmed(self):
        client = self.serve("--write")
        plant = client.ask(do="plant")["plant"]
        self.assertEqual([(bus["name"], bus["kind"], bus["baud"], bus["stations"]) for bus in plant["buses"]],
                         [("RS-485", "rs485", 9600, ["unit1"])])
        self.assertEqual(plant["stations"][0]["lines"], ["RS-485"])
        client.ask(do="watch", names=["P130"])
        client.ask(do="subscribe", topic="watch")
        client.wait_for("watch")
        client.ask(do="subscribe", topic="bus")
        event = client.wait_for("bus", lambda event: any(row["count"] > 4 for row in event["rows"]))
        row = event["rows"][0]
        self.assertEqual((row["bus"], row["id"], len(row["data"])), ("RS-485", 1, 24))
        client.ask(do="unsubscribe", topic="watch")
        frames = client.ask(do="bus.trace")["frames"]
        self.assertTrue(all(frame["data"].startswith(("0201", "1D01")) and not frame["error"] for frame in frames))
        question = [frame for frame in frames if frame["data"].startswith("020186" + "31002116")]
        self.assertIn("read", question[-1]["text"])
        self.assertIn("8470", question[-1]["text"])
        answers = [frame["data"] for frame in frames if frame["data"].startswith("1D018631002116")]
        self.assertEqual(int(answers[-1][14:22], 16), 2000)
        times = [frame["us"] for frame in frames]
        self.assertEqual(times, sorted(times))

        octets = bytes.fromhex("020186310021160000" + "0000")
        check = 0
        for octet in octets:
            check ^= octet
        data = octets.hex() + f"{check:02x}"
        self.assertIn("confirm", client.ask(do="bus.send", bus="RS-485", data=data)["error"])
        client.ask(do="arm", yes=True)
        before = client.ask(do="bus.trace")["frames"][-1]["n"]
        self.assertTrue(client.ask(do="bus.send", bus="RS-485", data=data).get("ok"))
        time.sleep(0.3)
        new = [frame["data"] for frame in client.ask(do="bus.trace")["frames"] if frame["n"] > before]
        self.assertEqual(new[0], data.upper())
        self.assertEqual(new[1][:22], "1D018631002116000007D0"[:22])
        self.assertIn("no bus", client.ask(do="bus.send", bus="dp", data="00")["error"])

    def test_a_telegram_needs_write(self):
        client = self.serve()
        self.assertIn("--write", client.ask(do="bus.send", bus="RS-485", data="0201")["error"])

    @staticmethod
    def telegram(address, typ, *words):
        """02 ADR TYP, words with the high byte first, BCC (1053 1610 p. 18-25)."""
        octets = bytes([2, address, typ]) + struct.pack(f">{len(words)}H", *words)
        check = 0
        for octet in octets:
            check ^= octet
        return (octets + bytes([check])).hex()

    def test_a_telegram_that_could_enable_a_drive_needs_its_monitoring(self):
        client = self.serve("--write")
        client.ask(do="arm", yes=True)

        def send(data):
            return client.ask(do="bus.send", bus="RS-485", data=data).get("error", "")

        for typ, *words in ((5, 6, 1000, 0), (3, 6, 1000), (1, 6), (5, 0, 0, 0x0C16), (5, 0x000E, 1, 1)):
            with self.subTest(typ=typ, words=words):
                self.assertIn("Switch the monitoring on first: P812 = 0.5 s", send(self.telegram(1, typ, *words)))
        with_parameter = self.telegram(1, 4, 0x3100, 0x2116, 0, 0, 6, 1000, 0)
        self.assertIn("P812", send(with_parameter))
        for harmless in (self.telegram(1, 5, 0, 1000, 0), self.telegram(1, 5, 2, 1000, 0), self.telegram(1, 5, 1, 7, 3),
                         self.telegram(1, 6, 0x3100, 0x2116, 0, 6), self.telegram(1, 5, 6, 6, 6)[:-2] + "ff"):
            self.assertEqual(send(harmless), "")
        self.assertIn("does not tell", send(self.telegram(2, 5, 6, 1000, 0)))
        for group in (100, 101, 199, 254, 255):
            self.assertIn("several drives", send(self.telegram(group, 5, 6, 1000, 0)))
        for too_long in ("650 s", "649.99 s", "10 s", "0.51 s"):  # a shaft turns on for as long
            client.ask(do="parameters.set", number="P812", value=too_long)
            self.assertIn("P812 is off or longer than 500 ms", send(self.telegram(1, 5, 6, 1000, 0)), too_long)
        client.ask(do="parameters.set", number="P812", value="0.5 s")
        client.ask(do="parameters.set", number="P833", value="NO RESPONSE")
        refused = send(self.telegram(1, 5, 6, 1000, 0))
        self.assertIn("P833 lets it go on", refused)
        advice = refused.rpartition("P833 = ")[2]
        self.assertEqual(client.ask(do="parameters.set", number="P833", value=advice).get("text"), advice)
        client.ask(do="parameters.set", number="P833", value="RAPID STOP/WARNG")
        for acyclic in (0x85, 0x81, 0x83):
            self.assertIn("acyclic", send(self.telegram(1, acyclic, *[6, 1, 1][:(acyclic & 7) // 2 + 1])))
        self.assertEqual(send(self.telegram(1, 5, 6, 1000, 0)), "")

    def test_it_writes_when_confirmed_and_stops_when_the_hand_is_off(self):
        client = self.serve("--write")
        self.assertIn("confirm", client.ask(do="parameters.set", number="P130", value="1 s")["error"])
        client.ask(do="arm", yes=True)
        self.assertEqual(client.ask(do="parameters.set", number="P130", value="1 s").get("text"), "1.000 s")
        self.assertTrue(client.ask(do="parameters.set", number="P130", value="3000 s")["refused"])
        client.ask(do="watch", names=["P000"])
        client.ask(do="subscribe", topic="watch")
        speed = 0
        for _ in range(100):
            self.assertTrue(client.ask(do="jog", direction="cw", rpm=300)["ok"])
            for event in client.events:
                speed = event.get("values", {}).get("unit1.P000", {}).get("value", speed)
            client.events.clear()
            if speed > 200_000:
                break
            time.sleep(0.05)
        self.assertGreater(speed, 200_000)
        client.wait_for("watch", lambda event: event["values"].get("unit1.P000", {}).get("value") == 0)


@unittest.skipUnless(os.path.exists("/dev/pts/ptmx"), "there is no /dev/pts: no pseudo-terminals here")
class SilentAtFirst(unittest.TestCase):
    """A drive of this test, at the far end of a pseudo-terminal: it does not answer the first questions of an index."""

    TRIES = 6  # of ipos for one question: three, and its master repeats each
    values = {}

    def drive(self):
        rest, asked = b"", {}
        while not self.done:
            if not select.select([self.far], [], [], 0.05)[0]:
                continue
            rest += os.read(self.far, 4096)
            while len(rest) >= 12:
                question, rest = rest[:12], rest[12:]
                index = int.from_bytes(question[5:7], "big")
                asked[index] = asked.get(index, 0) + 1
                if index in self.silent and asked[index] <= self.TRIES:
                    continue
                octets = b"\x1d" + question[1:7] + self.values.get(index, 0).to_bytes(4, "big")
                check = 0
                for octet in octets:
                    check ^= octet
                time.sleep(0.02)  # the question takes 14 ms at 9.6 kbaud, and a pause is in front of an answer
                os.write(self.far, octets + bytes([check]))

    def serve(self):
        self.done = False
        self.far, near = os.openpty()
        name = os.ttyname(near)
        tty.setraw(near)
        self.addCleanup(os.close, self.far)
        self.addCleanup(os.close, near)
        thread = threading.Thread(target=self.drive)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(lambda: setattr(self, "done", True))
        return client_of_device(self, name, "--unit", "md60a")

    def test_all_that_the_scope_proposes_is_recorded(self):
        self.silent = {8318, 8321, 8325}  # P000, P004 and P008
        client = self.serve()
        client.ask(do="subscribe", topic="scope")
        self.assertEqual(what_is_recorded(client), ["unit1.P000", "unit1.P004", "unit1.P008"])

    # TYP 85h: three process data words, acyclic (1053 1610 p. 18-25); BCC is the exclusive or of all bytes before.
    def test_the_meaning_of_process_data_words_is_told(self):
        self.silent = {8304}  # P870
        self.values = {8304: 9}  # CTRL. WORD 1
        client = self.serve()
        for _ in range(100):
            text = client.ask(do="bus.decode", frames=[{"bus": "RS-485", "id": 1, "data": "020185000600000000" + "80"}])["texts"][0]
            if "CTRL. WORD 1" in text:
                break
            time.sleep(0.1)
        self.assertIn("CTRL. WORD 1 0006h", text)


class OpensABrowser(unittest.TestCase):
    def test_the_token_is_in_no_argument(self):
        """A script in the place of xdg-open says what it is given."""
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "plant.toml").write_text('[[station]]\nname = "saw"\nunit = "md60a"\n')
            opener = folder / "xdg-open"
            opener.write_text(f'#!/bin/sh\necho "$@" > {folder}/given.tmp\ncat "$1" > {folder}/page\nstat -c %a "$1" > {folder}/mode\n'
                              f'mv {folder}/given.tmp {folder}/given\n')
            opener.chmod(0o755)
            ipos = subprocess.Popen([IPOS, "serve", str(folder / "plant.toml"), "--open"], stdout=subprocess.PIPE, text=True,
                                    env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}",
                                         "XDG_STATE_HOME": str(folder / "state")})
            try:
                address = ipos.stdout.readline().strip()
                given = folder / "given"
                for _ in range(1000):
                    if given.exists():
                        break
                    time.sleep(0.02)
                self.assertNotIn(address.split("=")[1], given.read_text())
                self.assertIn(f"url={address}", (folder / "page").read_text())
                self.assertEqual((folder / "mode").read_text().strip(), "600")
            finally:
                ipos.send_signal(signal.SIGINT)
                ipos.wait(timeout=30)
                ipos.stdout.close()
            self.assertEqual([path.name for path in (folder / "state" / "ipos").iterdir() if path.name.startswith("open")], [])


class NotServing(unittest.TestCase):
    def run_ipos(self, *arguments):
        return subprocess.run([IPOS, "serve", *arguments], capture_output=True, text=True, timeout=60, check=False)

    def test_too_few_descriptors_are_told(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket() as taken:  # so that it ends where there are enough
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            plant = pathlib.Path(folder) / "plant.toml"
            plant.write_text('[[station]]\nname = "saw"\nunit = "md60a"\n')
            for limit in range(4, 14):
                result = subprocess.run(["sh", "-c", f'ulimit -n {limit}; exec "$0" serve "$1" --port "$2"', IPOS, str(plant),
                                         str(taken.getsockname()[1])], capture_output=True, text=True, timeout=60, check=False)
                self.assertNotIn("internal error", result.stderr, limit)
                self.assertIn(result.returncode, (66, 74, 127), f"{limit}: {result.stderr}")

    def test_a_port_that_is_taken_is_told(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket() as taken:
            plant = pathlib.Path(folder) / "plant.toml"
            plant.write_text('[[station]]\nname = "saw"\nunit = "md60a"\n')
            taken.bind(("127.0.0.1", 0))
            taken.listen()
            result = self.run_ipos(str(plant), "--port", str(taken.getsockname()[1]))
            self.assertEqual(result.returncode, 74)
            self.assertIn("cannot be listened at", result.stderr)
            result = self.run_ipos(str(plant), "--bind", "here")
            self.assertEqual(result.returncode, 64)

    def test_a_port_of_the_plant_that_is_not_there_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            plant = pathlib.Path(folder) / "plant.toml"
            plant.write_text('[[bus]]\nname = "line1"\nkind = "rs485"\nport = "/dev/ttyNONE"\n'
                             '[[station]]\nname = "saw"\nunit = "md60a"\nrs485 = "line1"\n')
            result = self.run_ipos(str(plant))
            self.assertEqual(result.returncode, 74)
            self.assertEqual(result.stdout, "")
            self.assertIn("plant.toml:4:8: error: /dev/ttyNONE", result.stderr)

    def test_a_plant_with_mistakes_is_told(self):
        with tempfile.TemporaryDirectory() as folder:
            plant = pathlib.Path(folder) / "plant.toml"
            plant.write_text('[[station]]\nname = "saw"\nunit = "mill"\n')
            result = self.run_ipos(str(plant))
            self.assertEqual(result.returncode, 65)
            self.assertEqual(result.stdout, "")


if __name__ == "__main__":
    unittest.main(verbosity=1)
