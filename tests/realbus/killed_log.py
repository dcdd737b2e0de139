"""killed_log.py IPOS PLANT: the log of a real-time run that is killed (kill -9) has all but the last second. A host that is
busy with other things may be late, so there are three tries."""
import os
import subprocess
import sys
import tempfile
import time

from checks import check

ipos, plant = sys.argv[1:]


def last_stamp(path):
    with open(path) as log:
        lines = log.read().splitlines()
    return float(lines[-1].split()[0].strip("()")) if lines else None


def attempt():
    with tempfile.TemporaryDirectory() as folder:
        log = f"{folder}/can.log"
        run = subprocess.Popen([ipos, "run", plant, "--realtime", "--for", "24h", "--log", log], stderr=subprocess.DEVNULL)
        while not (os.path.exists(log) and last_stamp(log)):
            time.sleep(0.01)
            if run.poll() is not None:
                return False
        begin, first = time.monotonic(), last_stamp(log)
        time.sleep(2.5)
        run.kill()
        ran = time.monotonic() - begin
        run.wait()
        print(f"{ran:.3f} s, of which the log has {last_stamp(log) - first:.3f} s")
        return last_stamp(log) - first > ran - 1


check("the log of a killed run", any(attempt() for _ in range(3)), True)
print("end")
