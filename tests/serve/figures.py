"""What the page costs a plant, and what it keeps: `python3 figures.py IPOS [MINUTES]` prints it. Not a test.

64 drives, each sending seven bytes every 10 ms with a moving axis, as fast as it goes; once with nobody there, once
with a client that has all topics at 20 a second. Then, for so many minutes, the plant runs at the pace of the clock
with the client, and the memory of both processes is told each minute.
"""
import pathlib
import subprocess
import sys
import tempfile
import time

PROGRAM = """#include <const.h>
SCTRCYCL TrCycl;
long lLow;
long lHigh;
main()
{
  TrCycl.ObjectNo = NUMBER;
  TrCycl.CycleTime = 10;
  TrCycl.Offset = 0;
  TrCycl.Format = 7;
  TrCycl.DPointer = numof(lLow);
  _SBusCommDef(SCD_TRCYCL, TrCycl);
  _SBusCommOn();
  while (1) { lLow++; _GoAbs(GO_WAIT, 100000); _GoAbs(GO_WAIT, 0); }
}
"""
TOPICS = ("plant", "watch", "scope", "bus", "trace", "journal")


def write_plant(folder, drives):
    text = '[[bus]]\nname = "sbus"\nkind = "can"\nbaud = 1000000\n'
    for number in range(drives):
        (folder / f"D{number}.IPC").write_text(PROGRAM.replace("NUMBER", str(1100 + number)))
        text += (f'[[station]]\nname = "d{number}"\nunit = "mdxb"\nprogram = "D{number}.IPC"\nsbus = "sbus"\n'
                 f"[station.parameters]\nP881 = {number}\nP884 = 3\nP700 = 13\nP903 = 5\n"
                 "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n")
    (folder / "plant.toml").write_text(text)
    return folder / "plant.toml"


def memory(pid):
    """kB of a process and its children."""
    total = 0
    for line in pathlib.Path(f"/proc/{pid}/status").read_text().splitlines():
        if line.startswith("VmRSS"):
            total += int(line.split()[1])
    for child in pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
        total += memory(child)
    return total


class Page:
    def __init__(self, program, plant, client_class):
        self.process = subprocess.Popen([program, "serve", str(plant), "--no-snapshots"], stdout=subprocess.PIPE, text=True)
        address = self.process.stdout.readline()
        self.port, self.token = int(address.split(":")[2].split("/")[0]), address.strip().split("=")[1]
        self.client_class = client_class
        self.bytes = 0

    def client(self):
        return self.client_class(self.port, f"/ws?token={self.token}")

    def listen(self, client, seconds):
        """The last time event; counts the bytes that come."""
        end = time.monotonic() + seconds
        last = None
        while time.monotonic() < end:
            opcode, data = client.receive()
            self.bytes += len(data)
            if opcode == 1 and b'"event":"time"' in data:
                last = data
        return last

    def close(self):
        self.process.terminate()
        self.process.wait()


def main():
    program = sys.argv[1]
    minutes = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    sys.argv = ["client.py", program]
    import json
    sys.path.insert(0, str(pathlib.Path(__file__).parent))
    from client import Client

    with tempfile.TemporaryDirectory() as folder:
        plant = write_plant(pathlib.Path(folder), 64)
        seconds = 20
        for subscribes in (False, True):
            page = Page(program, plant, Client)
            client = page.client()
            names = [one["name"] for one in client.ask(do="search", text="lLow", limit=64)["names"]]
            client.ask(do="watch", names=names)
            client.ask(do="run", speed=0)
            time.sleep(2)
            if subscribes:
                for topic in TOPICS:
                    client.ask(do="subscribe", topic=topic, rate=20)
                begin = json.loads(page.listen(client, 1))["us"]
                page.bytes = 0
                end = json.loads(page.listen(client, seconds))["us"]
            else:
                begin = json.loads(page.listen(client, 1))["us"]
                end = json.loads(page.listen(client, seconds))["us"]
            text = f"{(end - begin) / 1e6 / seconds:8.2f} simulated seconds a second"
            print(f"with all topics: {text}, {page.bytes / seconds / 1000:.0f} kB/s" if subscribes else f"nobody looks:    {text}",
                  flush=True)
            client.close()
            page.close()
        if minutes:
            page = Page(program, plant, Client)
            client = page.client()
            client.ask(do="run", speed=1)
            for topic in TOPICS:
                client.ask(do="subscribe", topic=topic, rate=10)
            for minute in range(minutes + 1):
                print(f"{minute:4d} min: {memory(page.process.pid)} kB", flush=True)
                page.listen(client, 60)
            client.close()
            page.close()


if __name__ == "__main__":
    main()
