"""Ports of a plant that `ipos serve` serves: a telegram from outside, a PROFIBUS master, and ports that go away and come
back.
"""
import os
import pathlib
import re
import select
import subprocess
import tempfile
import time
import tty
import unittest

from client import IPOS, Client

# One unit at an RS-485 line with a port.
LINE = '''
[[bus]]
name = "line1"
kind = "rs485"
port = "{}"
[[station]]
name = "saw"
unit = "md60a"
rs485 = "line1"
[station.parameters]
P810 = 1
'''
# 02 ADR TYP PDU BCC: TYP 86h, service 31h, index 2116h, P130 = 2 s as delivered (1053 1610 p. 18-25); 1D begins answers.
QUESTION = bytes.fromhex("020186310021160000000083")
ANSWER = bytes.fromhex("1d018631002116000007d0")


def answer_at(port):
    """What comes back at a descriptor, without its BCC; a busy machine may tear a telegram apart, so it is asked again."""
    answer = b""
    for _ in range(30):
        os.write(port, QUESTION)
        ends, answer = time.monotonic() + 1, b""
        while len(answer) <= len(ANSWER) and time.monotonic() < ends:
            if select.select([port], [], [], 0.1)[0]:
                answer += os.read(port, 64)
        if len(answer) > len(ANSWER):
            break
    return answer[:len(ANSWER)]


@unittest.skipUnless(os.path.exists("/dev/pts/ptmx"), "there is no /dev/pts: no pseudo-terminals here")
class PlantWithAPort(unittest.TestCase):
    """A plant that is served while somebody outside asks its drive."""

    def test_it_answers_at_its_port_and_time_is_that_of_the_world(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        line = pathlib.Path(folder.name) / "line1"
        plant = pathlib.Path(folder.name) / "plant.toml"
        plant.write_text(LINE.format(f"pty:{line}"))
        ipos = subprocess.Popen([IPOS, "serve", str(plant)], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(ipos.stdout.close)
        self.addCleanup(ipos.wait)
        self.addCleanup(ipos.terminate)
        match = re.search(r":(\d+)/\?token=(\w+)", ipos.stdout.readline())
        client = Client(int(match[1]), f"/ws?token={match[2]}")
        self.addCleanup(client.close)
        self.assertTrue(client.wait_for("hello")["live"])
        for command in ({"do": "pause"}, {"do": "step"}, {"do": "back", "ms": 1}, {"do": "restart"},
                        {"do": "speed", "speed": 2}, {"do": "run", "speed": 2}):
            self.assertIn("real ports", client.ask(**command)["error"])
        self.assertTrue(client.ask(do="run")["ok"])
        # 02 ADR TYP 05h: three words; 6 enables. A drive at the port cannot be asked; the plant's own is here to be tried.
        for data, trouble in (("02020500061388000098", "outside of the plant"), ("0201050006138800009b", ""),
                              ("0202050002138800009c", "")):
            self.assertIn(trouble, client.ask(do="bus.send", bus="line1", data=data).get("error", ""))
            time.sleep(0.1)
        first = client.wait_for("time", lambda event: event["us"] > 0)
        self.assertTrue(first["running"])

        port = os.open(line, os.O_RDWR | os.O_NOCTTY)
        self.addCleanup(os.close, port)
        self.assertEqual(answer_at(port), ANSWER)
        trace = [frame["data"] for frame in client.ask(do="bus.trace")["frames"]]
        self.assertIn(QUESTION.hex().upper(), trace)


def sd1(receiver, sender, function):
    return bytes([0x10, receiver, sender, function, receiver + sender + function & 0xFF, 0x16])


def sd2(receiver, sender, function, data=b"", points=()):
    mark = 0x80 if points else 0
    body = bytes([receiver | mark, sender | mark, function, *points]) + data
    return bytes([0x68, len(body), len(body), 0x68]) + body + bytes([sum(body) & 0xFF, 0x16])


class DpMaster:
    """A master of class 1 with one slave, at a pseudo-terminal (EN 50170 volume 2): access points 60 Slave_Diag, 61
    Set_Prm, 62 Chk_Cfg and of the master 62."""

    def __init__(self, path, slave):
        self.port = os.open(path, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
        tty.setraw(self.port)
        self.slave = slave
        self.bit = None  # frame count bit of the next request; None: a sequence begins

    def ask(self, data=b"", point=None):
        """Data of the answer, b"" of a short acknowledgement; None without one after some tries."""
        function = 0x6D if self.bit is None else 0x7D if self.bit else 0x5D
        frame = sd2(self.slave, 1, function, data, (point, 62) if point else ())
        for _ in range(5):
            os.write(self.port, frame)
            answer, ends = b"", time.monotonic() + 1
            while time.monotonic() < ends and not self.whole(answer):
                if select.select([self.port], [], [], 0.01)[0]:
                    answer += os.read(self.port, 4096)
            if self.whole(answer):
                self.bit = False if self.bit is None else not self.bit
                return b"" if answer == b"\xE5" else answer[9 if point else 7:-2]
        self.bit = None
        return None

    @staticmethod
    def whole(answer):
        return answer == b"\xE5" or (answer[:1] == b"\x68" and len(answer) == answer[1] + 6)

    def start(self, watchdog_ms, configuration):
        """The slave finds the rate by what it hears; nobody has the address 125."""
        for _ in range(30):
            os.write(self.port, sd1(125, 1, 0x49))
            time.sleep(0.01)
        self.bit = None
        diagnosis = self.ask(point=60)
        if diagnosis is None:
            return False
        parameters = bytes([0xB8, watchdog_ms // 10, 1, 11]) + diagnosis[4:6] + b"\0"
        return self.ask(parameters, 61) == b"" and self.ask(configuration, 62) == b"" and self.ask(point=60)[1] & 1 == 0


@unittest.skipUnless(os.path.exists("/dev/pts/ptmx"), "there is no /dev/pts: no pseudo-terminals here")
class PortsOfAPlant(unittest.TestCase):
    """What a served plant does with its ports: a PROFIBUS master outside, and ports that go away and come back."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def serve(self, plant):
        (self.folder / "plant.toml").write_text(plant)
        ipos = subprocess.Popen([IPOS, "serve", str(self.folder / "plant.toml")], stdout=subprocess.PIPE,
                                stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(ipos.stdout.close)
        self.addCleanup(ipos.wait)
        self.addCleanup(ipos.terminate)
        match = re.search(r":(\d+)/\?token=(\w+)", ipos.stdout.readline())
        self.assertTrue(match)
        self.ipos = ipos
        return self.connect(match)

    def connect(self, match=None):
        self.place = match or self.place
        client = Client(int(self.place[1]), f"/ws?token={self.place[2]}")
        self.addCleanup(client.close)
        return client

    def journal(self):
        client = self.connect()
        client.ask(do="subscribe", topic="journal")
        entries = client.wait_for("journal")["entries"]
        client.close()
        return [(entry["us"], entry["weight"], entry["text"]) for entry in entries]

    def seconds_of_cpu(self):
        """Of the server and of the process that has the plant."""
        pid = str(self.ipos.pid)
        ticks = 0
        for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                name, fields = stat.parent.name, stat.read_text().rpartition(") ")[2].split()
            except OSError:
                continue
            if pid in (name, fields[1]):
                ticks += int(fields[11]) + int(fields[12])
        return ticks / os.sysconf("SC_CLK_TCK")

    def test_a_profibus_master_outside_runs_a_slave_while_the_page_watches(self):
        path = self.folder / "dp"
        client = self.serve(f'''
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
port = "pty:{path}"
[[station]]
name = "pump"
unit = "mc31"
option = "size0"
profibus = "dp"
profibus_address = 9
[station.parameters]
P572 = "RAPID STOP/WARNG"
P600 = "NO FUNCTION"
P601 = "NO FUNCTION"
P841 = "FIELDBUS"
[station.inputs]
DI00 = 1
''')
        self.assertTrue(client.wait_for("hello")["live"])
        for command in ({"do": "pause"}, {"do": "step"}, {"do": "back", "ms": 1}, {"do": "run", "speed": 2}):
            self.assertIn("real ports", client.ask(**command)["error"])
        self.assertIn(f"pty:{path}", client.ask(do="plant")["plant"]["buses"][0]["stations"])
        # The page sends output data that could enable a drive to the plant's own slave only.
        for slave, trouble in ((10, "outside of the plant"), (9, "")):
            for data in (sd2(slave, 1, 0x7D, bytes(8) + b"\0\6\5\xDC\0\0"), sd2(slave, 1, 0x7D, bytes(8) + b"\0\2\0\0\0\0")):
                error = client.ask(do="bus.send", bus="dp", data=data.hex(" ")).get("error", "")
                self.assertIn(trouble if b"\6\5" in data else "", error)
                self.assertEqual(error == "", trouble == "" or b"\6\5" not in data, error)
                time.sleep(0.05)
        master = DpMaster(path, 9)
        self.addCleanup(os.close, master.port)
        # Process data 6, 1500 digits of 0.2 rpm; F3 F2: a parameter channel and three words.
        speed, good = 0, 0
        for _ in range(1000):  # a busy machine may be late for the watchdog, then it starts again
            if good == 0 and not master.start(2000, b"\xF3\xF2"):
                continue
            answer = master.ask(bytes(8) + (6).to_bytes(2, "big") + (1500).to_bytes(2, "big") + bytes(2))
            good = good + 1 if answer is not None and len(answer) == 14 else 0
            speed = int.from_bytes(answer[10:12], "big", signed=True) if good else 0
            if speed == 1500 and good > 50:
                break
        self.assertEqual(speed, 1500)
        client.ask(do="subscribe", topic="plant")
        pump = client.wait_for("plant", lambda event: "pump" in event["stations"])["stations"]["pump"]
        self.assertTrue(pump["enabled"], pump)
        self.assertAlmostEqual(pump["speed"], 300, delta=1)
        client.ask(do="subscribe", topic="bus")
        rows = client.wait_for("bus", lambda event: event["rows"])["rows"]
        ways = {(row["source"], row["destination"], row["dsap"]) for row in rows}
        self.assertTrue({(1, 9, None), (9, 1, None), (1, 9, 60), (1, 9, 61), (1, 9, 62)} <= ways, ways)
        # Faults strike what the master outside sends, too: no request comes through any more.
        self.assertTrue(client.ask(do="fault", bus="dp", kind="lost", station=f"pty:{path}", on=True).get("ok"))
        time.sleep(0.1)
        self.assertIsNone(master.ask(point=60))

    def test_a_program_leaves_its_pseudo_terminal_and_comes_back(self):
        path = self.folder / "line1"
        client = self.serve(LINE.format(f"pty:{path}"))
        first = client.wait_for("ports")["ports"]
        self.assertEqual(first, [{"bus": "line1", "name": f"pty:{path}", "there": False, "since_us": None,
                                  "text": "no program has its other end open"}])
        for _ in range(2):
            port = os.open(path, os.O_RDWR | os.O_NOCTTY)
            there = client.wait_for("ports")["ports"][0]
            self.assertTrue(there["there"])
            os.close(port)
            away = client.wait_for("ports")["ports"][0]
            self.assertFalse(away["there"])
            self.assertGreater(away["since_us"], there["since_us"])
        texts = [text for _, _, text in self.journal() if "port" in text]
        name = f"line1: port pty:{path}"
        gone = f"{name} is away: no program has its other end open"
        self.assertEqual(texts, [f"{name} is there", gone, f"{name} is there again", gone])

    def test_a_program_that_comes_and_goes_does_not_fill_the_journal(self):
        path = self.folder / "line1"
        client = self.serve(LINE.format(f"pty:{path}"))
        client.wait_for("ports")
        for turn in range(1000):
            time.sleep(0.003)
            port = os.open(path, os.O_RDWR | os.O_NOCTTY)
            time.sleep(0.003)
            os.close(port)
            texts = [text for _, _, text in self.journal() if "port" in text] if turn % 50 == 49 else []
            if texts and "further changes" in texts[-1]:
                break
        self.assertEqual(len(texts), 100)
        port = os.open(path, os.O_RDWR | os.O_NOCTTY)
        self.addCleanup(os.close, port)
        client = self.connect()
        client.wait_for("ports", lambda event: event["ports"][0]["there"])
        time.sleep(0.1)
        self.assertEqual(len([text for _, _, text in self.journal() if "port" in text]), 100)

    def test_a_device_that_is_pulled_out_and_put_in_again(self):
        def plug():
            master, device = os.openpty()  # the far end of a pseudo-terminal does as a device
            name = os.ttyname(device)
            os.close(device)
            link.unlink(missing_ok=True)
            link.symlink_to(name)
            return master

        link = self.folder / "ttyUSB0"
        master = plug()
        client = self.serve(LINE.format(link))
        self.assertEqual([port["there"] for port in client.wait_for("ports")["ports"]], [True])
        link.unlink()
        os.close(master)
        away = client.wait_for("ports")["ports"][0]
        self.assertEqual((away["there"], away["text"]), (False, "the device has gone: Input/output error"))
        time.sleep(0.3)
        client = self.connect()
        begin = client.wait_for("time")["us"]
        before = self.seconds_of_cpu()
        client.wait_for("time", lambda event: event["running"] and event["us"] > begin + 1_500_000)
        self.assertLess(self.seconds_of_cpu() - before, 1.0, "it waits for the port without a pause")
        self.assertIsNone(client.wait_for("time")["stopped"])
        self.assertIn((away["since_us"], "warning", f"line1: port {link} is away: {away['text']}"), self.journal())

        master = plug()
        self.addCleanup(os.close, master)
        client = self.connect()
        client.wait_for("ports", lambda event: event["ports"][0]["there"])
        self.assertIn(f"line1: port {link} is there again", [text for _, _, text in self.journal()])
        self.assertEqual(answer_at(master), ANSWER)


if __name__ == "__main__":
    unittest.main(verbosity=1)
