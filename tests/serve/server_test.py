"""`ipos serve` with real sockets: who is let in, what is too much, and that it ends well."""
import json
import os
import pathlib
import random
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import time
import unittest

from client import IPOS, PATIENCE, Client

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
