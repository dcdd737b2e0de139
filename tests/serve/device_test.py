"""`ipos serve --device`: a simulated drive at a pseudo-terminal is a real one for it."""
import os
import pathlib
import re
import select
import signal
import struct
import subprocess
import tempfile
import threading
import time
import tty
import unittest

from client import IPOS, Client


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


if __name__ == "__main__":
    unittest.main(verbosity=1)
