"""The page of a plant with a foreign machine: its values are those of the closed form, on the way there and back."""
import math
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / "serve"))
from client import IPOS, PATIENCE, Client  # noqa: E402

FMUS = pathlib.Path(sys.argv.pop(1))
PLANT = """
[[station]]
name = "u"
unit = "md60a"
[[stimulus]]
station = "u"
at = "0ms"
variable = "H310"
set = 100
[[machine]]
name = "spring"
fmu = "spring2.fmu"
[machine.inputs]
torque = "u.H310"
[machine.outputs]
speed = "u.H300"
"load.speed" = "u.H301"
"""


def closed_form(t, load):
    """As in machine_test.cpp: two masses on a spring, a constant torque on the first."""
    torque, one, two, stiffness = 100, 0.01, 0.02, 100
    w = math.sqrt(stiffness * (one + two) / (one * two))
    swing = math.sin(w * t) / w
    return torque / (one + two) * (t - swing if load else t + two / one * swing)


class Page(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.plant = pathlib.Path(self.folder.name) / "plant.toml"
        self.plant.write_text(PLANT)
        shutil.copy(FMUS / "spring2.fmu", self.folder.name)

    def tearDown(self):
        self.folder.cleanup()

    def test_nobody_has_allowed_it(self):
        done = subprocess.run([IPOS, "serve", str(self.plant)], capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, 65)
        self.assertIn("--allow-fmu", done.stderr)

    def test_there_and_back(self):
        ipos = subprocess.Popen([IPOS, "serve", "--allow-fmu", str(self.plant)], stdout=subprocess.PIPE, text=True)
        try:
            port, token = re.fullmatch(r"http://127\.0\.0\.1:(\d+)/\?token=(\w+)", ipos.stdout.readline().strip()).groups()
            client = Client(int(port), f"/ws?token={token}")
            client.ask(do="watch", names=["u.H300", "u.H301"])

            def check(ms):
                client.ask(do="subscribe", topic="watch")
                event = client.wait_for("watch", lambda each: each["us"] == ms * 1000)
                for name, load in (("u.H300", False), ("u.H301", True)):
                    self.assertAlmostEqual(event["values"][name]["value"], closed_form(ms / 1000, load), delta=0.501, msg=(name, ms))

            for ms in (100, 200, 300, 400):
                self.assertEqual(client.ask(do="step", ms=100)["us"], ms * 1000)
                check(ms)
            for ms in (250, 120, 390):
                self.assertEqual(client.ask(do="go", us=ms * 1000)["us"], ms * 1000)
                check(ms)
            client.ask(do="go", us=200_000)
            self.assertEqual(client.ask(do="step", ms=500)["us"], 700_000)
            check(700)
            client.close()
        finally:
            ipos.kill()
            ipos.wait()
            ipos.stdout.close()


if __name__ == "__main__":
    unittest.main()
