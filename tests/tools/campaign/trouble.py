#!/usr/bin/env python3
"""What goes wrong while a campaign runs: trouble.py IPOS.

Killed at many moments, a worker that dies, two runners of one shard, a disk without room: no result is lost or comes twice, and each is told.
"""
import json
import os
import random
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

IPOS = sys.argv[1]
KILLS = int(os.environ.get("IPOS_KILLS", "12"))
PLANT = """
[[station]]
name = "a"
unit = "mdxb"
program = "A.IPC"
[station.parameters]
P938 = 9
"""
PROGRAM = "long lIn, lOut;\nmain() { while (1) { lOut = lIn * 2; } }\n"


def campaign(cases, duration="200ms", limit="60s"):
    return f"""
plant = "a.toml"
for = "{duration}"
limit = "{limit}"
[[vary]]
station = "a"
variable = "lIn"
from = 1
to = {cases}
steps = {cases}
[[measure]]
name = "out"
signal = "a.lOut"
take = "max"
"""


class Folder:
    def __init__(self, text):
        self.held = tempfile.TemporaryDirectory()
        self.path = Path(self.held.name)
        (self.path / "a.toml").write_text(PLANT)
        (self.path / "A.IPC").write_text(PROGRAM)
        (self.path / "a.campaign.toml").write_text(text)

    def command(self, *more):
        return [IPOS, "campaign", "run", "a.campaign.toml", "--out", "out", *more]

    def run(self, *more, **options):
        return subprocess.run(self.command(*more), cwd=self.path, capture_output=True, text=True, **options)

    def start(self, *more):
        return subprocess.Popen(self.command(*more), cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)

    def merge(self):
        return subprocess.run([IPOS, "campaign", "merge", "out", "--jsonl", "-"], cwd=self.path, capture_output=True, text=True)

    def lines(self, name="shard-1-of-1.jsonl"):
        file = self.path / "out" / name
        return file.read_bytes() if file.exists() else b""


def check(condition, what):
    if not condition:
        raise SystemExit(f"not so: {what}")


def workers_of(process):
    return [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text().split()]


def wait_for(condition, what):
    for _ in range(3000):
        if condition():
            return
        time.sleep(0.01)
    raise SystemExit(f"did not come: {what}")


def killed_at_random_moments():
    cases = 400 + 40 * KILLS
    whole = Folder(campaign(cases))
    check(whole.run().returncode == 0, "an undisturbed run is good")
    wanted = whole.merge().stdout
    folder = Folder(campaign(cases))
    chance = random.Random(7)
    kills = 0
    for _ in range(KILLS):
        run = folder.start("--jobs", "2")
        time.sleep(chance.uniform(0, 0.12))
        if run.poll() is None:
            kills += 1
        run.send_signal(signal.SIGKILL)
        run.communicate()
        # Whole lines but perhaps the last one, and no case twice.
        rows = folder.lines().split(b"\n")
        names = [json.loads(row)["case"] for row in rows[:-1]]
        check(len(names) == len(set(names)), "no case twice")
    last = folder.run()
    check(last.returncode == 0, f"the last run is good: {last.stderr}")
    check(folder.merge().stdout == wanted, "the same results as without a kill")
    check(not list((folder.path / "out").glob("*.lock")), "no lock is left")
    print(f"killed {kills} times: the same results")


def a_worker_that_dies():
    folder = Folder(campaign(3, "20000s"))
    (folder.path / "A.IPC").write_text("long lIn, lOut;\nmain() { while (1) { lOut = lIn * 2; H200 = H200 + lOut; } }\n")
    run = folder.start("--jobs", "1")
    for n in range(3):
        before = folder.lines().count(b"\n")
        wait_for(lambda: workers_of(run.pid), "a worker")
        time.sleep(0.3)
        os.kill(workers_of(run.pid)[0], signal.SIGSEGV)
        wait_for(lambda: folder.lines().count(b"\n") > before, "a result of the dead case")
    run.communicate(timeout=60)
    rows = [json.loads(row) for row in folder.lines().splitlines()]
    check(len(rows) == 3 and all(row["failed"][0].startswith("died: signal 11") for row in rows), f"deaths are results: {rows}")
    check(run.returncode == 1, "exit code 1")
    print("three workers died: three results")


def two_runners():
    folder = Folder(campaign(2, "20000s"))
    (folder.path / "A.IPC").write_text("long lIn, lOut;\nmain() { while (1) { lOut = lIn * 2; H200 = H200 + lOut; } }\n")
    first = folder.start("--shard", "1/2")
    wait_for(lambda: (folder.path / "out/shard-1-of-2.lock").exists(), "the lock")
    wait_for(lambda: (folder.path / "out/shard-1-of-2.lock").read_text(), "its owner")
    second = folder.run("--shard", "1/2")
    check(second.returncode == 75, f"the second one ends with 75, not {second.returncode}: {second.stderr}")
    check("another runner has this shard" in second.stderr, second.stderr)
    worker = workers_of(first.pid)
    first.send_signal(signal.SIGINT)
    first.communicate(timeout=30)
    check(first.returncode == 130, f"Ctrl-C ends it: {first.returncode}")
    check(all(not Path(f"/proc/{one}").exists() for one in worker), "its workers end with it")
    # One on another machine that is gone: its number stands still.
    (folder.path / "out/shard-1-of-2.lock").write_text("elsewhere/boot/pid:[1] 77 123 5")
    third = folder.start("--shard", "1/2")
    wait_for(lambda: "elsewhere" not in (folder.path / "out/shard-1-of-2.lock").read_text(), "taking over")
    third.send_signal(signal.SIGTERM)
    third.communicate(timeout=30)
    print("two runners: 75; one that is gone is followed")


def no_room():
    folder = Folder(campaign(400))

    def little():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

    full = folder.run(preexec_fn=little)
    check(full.returncode == 74, f"74, not {full.returncode}: {full.stderr}")
    check("shard-1-of-1.jsonl" in full.stderr, full.stderr)
    check(folder.lines().endswith(b"\n"), "the last line is whole")
    check(0 < folder.lines().count(b"\n") < 400, "some results")
    check(folder.run().returncode == 0, "with room the rest is run")
    check(folder.merge().stdout.count("\n") == 400, "all are there")
    print("no room: 74, and the rest later")


for trouble in (killed_at_random_moments, a_worker_that_dies, two_runners, no_room):
    trouble()
