"""A simulated drive at a pseudo-terminal that `ipos serve --device` takes for a real one, a hand on its button, and what
the shaft does: the trace of `ipos run --realtime`, in its own time."""
import bisect
import json
import os
import pathlib
import re
import select
import signal
import subprocess
import tempfile
import threading
import time

from client import IPOS, Client

RPM = 1500
FALLS_WITHIN = 0.7  # s: what the tests promise
PERIOD = 0.1  # s between two `jog`, as the page has it
PATIENCE = 240  # s for anything that must come: only what never comes takes as long
DRIVE_RUNS = 3600  # s: longer than any trial, so that none ends as its drive is over

# kind of line, unit, parameters. Where this program is silent for too long, the drive must stop, but it goes on with the next
# telegram, as RS-485 of MOVIDRIVE has it as delivered: a fault would wait for somebody who resets it. MOVITRAC 07 has no such
# choice, so somebody does. P815 of MOVIDRIVE A is 100 ms as delivered.
WARNING = "RAPID STOP/WARNG"
LINES = {
    "RS-485 md60a": ("rs485", "md60a", {}),
    "RS-485 mc07": ("rs485", "mc07", {"P604": "FAULT RESET"}),
    "RS-485 mdxb": ("rs485", "mdxb", {}),
    "SBus md60a": ("can", "md60a", {"P815": "0.4 s", "P836": WARNING}),
    "SBus mc07": ("can", "mc07", {"P604": "FAULT RESET"}),
    "SBus mdxb": ("can", "mdxb", {"P836": WARNING}),
    "SBus 2 mdxb": ("can", "mdxb", {"P836": WARNING, "P837": WARNING}),
}
RESET_AGAIN_AND_AGAIN = '[[stimulus]]\nstation = "saw"\nat = "1s"\ninput = "DI05"\npulse = 1\nfor = "20ms"\nevery = "500ms"\n'


def wait_until(what, condition, seconds=PATIENCE):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.01)
    raise TimeoutError(f"waited {seconds} s for: {what() if callable(what) else what}")


def plant_text(line, port, parameters, inputs, more):
    kind, unit, own = LINES[line]
    source = "RS-485" if kind == "rs485" else "SBus"
    second = line.startswith("SBus 2")
    address = "P810" if kind == "rs485" else "P891" if second else "P881" if unit == "mdxb" else "P813"
    settings = {"P870": "CTRL. WORD 1", "P871": "SPEED", "P100": source, "P101": source, address: 1, **own, **parameters}
    lines = ["[[bus]]", 'name = "line"', f'kind = "{kind}"', f'port = "{port}"', "[[station]]", 'name = "saw"',
             f'unit = "{unit}"', f'{"rs485" if kind == "rs485" else "sbus2" if second else "sbus"} = "line"', "[station.inputs]"]
    lines += [f"{name} = {value}" for name, value in inputs.items()]
    lines += ["[station.parameters]"]
    lines += [f"{name} = {json.dumps(value)}" for name, value in settings.items()]
    return "\n".join(lines) + "\n" + more + (RESET_AGAIN_AND_AGAIN if "P604" in own else "")


class Rig:
    """Drive, server and folder of one trial. Everything that was started ends with the test."""

    INPUTS = {"DI00": 1, "DI01": 1, "DI03": 1}

    def __init__(self, test, line="RS-485 md60a", parameters=None, inputs=None, more="", serve=("--write",)):
        self.test = test
        kind = LINES[line][0]
        folder = tempfile.TemporaryDirectory()
        test.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        place = self.folder / "port"
        self.port = f"slcan:{place}" if kind == "can" else str(place)
        pty = f"slcan:pty:{place}" if kind == "can" else f"pty:{place}"
        plant = self.folder / "plant.toml"
        plant.write_text(plant_text(line, pty, parameters or {}, inputs or self.INPUTS, more))
        self.csv = self.folder / "t.csv"
        self.environment = {**os.environ, "XDG_STATE_HOME": str(self.folder / "state")}
        self.drive = subprocess.Popen([IPOS, "run", str(plant), "--realtime", "--for", f"{DRIVE_RUNS}s", "--trace", str(self.csv),
                                       "--signals", "saw.speed"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        test.addCleanup(self.drive.wait)
        test.addCleanup(self.drive.kill)
        wait_until(f"the port {place}", place.exists)
        self.servers = []
        self.rows, self.unread, self.read_to = [], "", 0
        self.clocks = []  # (this test's, by how much the drive's is less)
        self.serve(*serve)

    # --- the server ---

    def serve(self, *more):
        """Another one at the same port."""
        for _ in range(15):  # a machine that has more to do than it can may answer no question in its time
            self.server = subprocess.Popen([IPOS, "serve", "--device", self.port, "--address", "1", "--quiet", *more],
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True,
                                           env=self.environment)
            server = self.server
            self.test.addCleanup(server.stderr.close)
            self.test.addCleanup(server.stdout.close)
            self.test.addCleanup(server.wait)
            self.test.addCleanup(self.signal_group, server, signal.SIGKILL)
            match = re.search(r":(\d+)/\?token=(\w+)", server.stdout.readline())
            if match:
                break
        self.test.assertTrue(match, "the server has not come up")
        self.http, self.token = int(match[1]), match[2]
        self.host = wait_until("the process with the line", lambda: self.child(server.pid))

    @staticmethod
    def child(parent):
        try:
            return int(pathlib.Path(f"/proc/{parent}/task/{parent}/children").read_text().split()[0])
        except (OSError, IndexError):
            return None

    @staticmethod
    def signal_group(server, number):
        try:
            os.killpg(server.pid, signal.SIGCONT)
            os.killpg(server.pid, number)
        except ProcessLookupError:
            pass

    def connect(self):
        try:
            client = Client(self.http, f"/ws?token={self.token}")
        except OSError as error:
            raise AssertionError(f"{error}; {self.state()}") from error
        self.test.addCleanup(client.close)
        return client

    def armed(self):
        client = self.connect()
        self.test.assertTrue(client.ask(do="arm", yes=True)["ok"])
        return client

    def state(self):
        """Who has ended, and what the server has said until then."""
        file = self.server.stderr.fileno()
        said = os.read(file, 4096) if select.select([file], [], [], 0)[0] else b""
        return f"server {self.server.poll()}, drive {self.drive.poll()}, {said.decode()!r}"

    def records(self):
        """Of what was changed in the drive; other files there are the page's."""
        return list((self.folder / "state" / "ipos").glob("borrowed-*"))

    def end(self):
        self.signal_group(self.server, signal.SIGKILL)
        self.drive.kill()

    # --- the shaft ---

    def look(self):
        """New rows of the trace; and how the clock of this test stands to the time of the drive."""
        if not self.csv.exists():
            return
        with open(self.csv, encoding="utf-8") as file:
            file.seek(self.read_to)
            text = file.read()
            self.read_to = file.tell()
        *lines, self.unread = (self.unread + text).split("\n")
        for line in lines:
            milliseconds, _, speed = line.partition(",")
            if milliseconds[:1].isdigit():
                self.rows.append((int(milliseconds) / 1000, float(speed)))
        if lines and self.rows:
            now = time.monotonic()
            self.clocks.append((now, now - self.rows[-1][0]))

    def speed(self):
        self.look()
        return self.rows[-1][1] if self.rows else 0

    def row_after(self, moment):
        """The number of the first row behind a moment of this test's clock."""
        return bisect.bisect(self.rows, (self.drive_time(moment), RPM * 9))

    def drive_time(self, moment):
        """By what was read right behind the moment: a drive that had no processor leaves time out, and its clock is another from
        then on."""
        behind = [less for at, less in self.clocks[bisect.bisect(self.clocks, (moment - 0.02, 0)):] if at < moment + 0.7]
        return moment - min(behind or [self.clocks[-1][1]])

    def wait_for_time(self, moment):
        wait_until("the drive's time", lambda: self.look() or self.row_after(moment) < len(self.rows))

    def fastest(self, moment):
        """Since a moment."""
        return max((abs(speed) for _, speed in self.rows[self.row_after(moment):]), default=0)

    def moves_at(self, moment):
        return abs(self.rows[self.row_after(moment) - 1][1]) >= RPM * 0.02

    def wait_for_speed(self, wanted=RPM * 0.99):
        wait_until(lambda: f"{wanted:.0f} rpm, it has {self.speed():.0f}; {self.state()}", lambda: abs(self.speed()) >= wanted)

    def after(self, moment):
        """(begins to fall, stands, the speed from which it falls): seconds after a moment of this test's clock; the time is the
        drive's."""
        begin = self.drive_time(moment)
        first = self.row_after(moment)
        top = abs(self.rows[first - 1][1])
        falls = stands = None
        for at, speed in self.rows[first:]:
            top = max(top, abs(speed)) if falls is None else top
            if falls is None and abs(speed) < top * 0.98:
                falls = at - begin
            if falls is not None and abs(speed) < 1:
                stands = at - begin
                break
        return falls, stands, top

    def wait_until_it_stands(self, moment):
        wait_until("the shaft to stand", lambda: self.look() or self.after(moment)[1] is not None)
        return self.after(moment)


class Hand:
    """Holds the button as the page does: a `jog` each 100 ms, without waiting for the replies."""

    def __init__(self, client, direction="cw", rpm=RPM):
        self.client, self.direction, self.rpm = client, direction, rpm
        self.held = True
        self.errors, self.events, self.accepted = [], [], 0
        self.thread = threading.Thread(target=self.hold)
        self.thread.start()

    def hold(self):
        due = time.monotonic()
        try:
            while self.held:
                self.client.id += 1
                self.client.send(json.dumps({"id": self.client.id, "do": "jog", "direction": self.direction,
                                             "rpm": self.rpm}).encode())
                due += PERIOD
                while self.held and time.monotonic() < due:
                    self.read(max(0, min(0.02, due - time.monotonic())))
        except (OSError, EOFError, ValueError):
            pass

    def read(self, seconds):
        if not self.client.rest and not select.select([self.client.socket], [], [], seconds)[0]:
            return
        opcode, data = self.client.receive()
        if opcode == 1:
            message = json.loads(data)
            self.accepted += message.get("ok") is True
            if "error" in message:
                self.errors.append(message["error"])
            if message.get("event") == "manual":
                self.events.append(message)

    def off(self):
        """The hand is off, and nobody says so."""
        self.held = False
        self.thread.join()
        return time.monotonic()

    def release(self):
        """As the page does it."""
        moment = self.off()
        self.client.id += 1
        self.client.send(json.dumps({"id": self.client.id, "do": "jog", "direction": "stop", "rpm": 0}).encode())
        return moment

    def close(self):
        moment = self.off()
        self.client.close()
        return moment
