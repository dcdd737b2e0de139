"""A name of a station means one thing in every front end: a row a name, a column a front end.

The program has variables that are called like values of the unit. A program's own name hides the unit's; "drive.NAME"
is always the unit's.
"""

import csv
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import ipos

IPOS = os.environ.get("IPOS", "")
PLANT = """
[[station]]
name = "u"
unit = "mdxb"
program = "U.IPC"
[station.parameters]
P160 = "300 rpm"
P601 = "ENABLE/RAP.STOP"
P602 = "NO FUNCTION"
P603 = "n11/n21"
P130 = "0.1 s"
[station.inputs]
DI00 = 1
DI01 = 1
DI02 = 1
DI04 = 1
[[station]]
name = "w"
unit = "md60a"
"""
PROGRAM = """
long speed, fault, DI03, torque, lag[2];
main()
{
    speed = 77;
    fault = 5;
    DI03 = 9;
    torque = 4;
    lag[1] = 8;
    H200 = 12;
    while (1) { }
}
"""
# The shaft turns at the internal setpoint of 300 rpm at 2 s, and nothing is at DI03.
ROWS = {
    "speed": 77,
    "fault": 5,
    "DI03": 9,
    "torque": 4,
    "lag[1]": 8,
    "H200": 12,
    "drive.speed": 300,
    "drive.fault": 0,
    "drive.DI03": 0,
    "setpoint": 300,
    "shaft_speed": 300,
    "drive.shaft_speed": 300,
    "enabled": 1,
    "DI00": 1,
    "drive.DI00": 1,
    "PO1": 0,
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "p.toml").write_text(PLANT)
    (tmp_path / "U.IPC").write_text(PROGRAM)
    return tmp_path


def run(folder, *arguments, **more):
    return subprocess.run([IPOS, *arguments], cwd=folder, capture_output=True, text=True, timeout=60, **more).stdout


def number(text):
    """The number that a text begins with: "300.000 rpm" is 300."""
    return float(re.match(r"-?[0-9.]+", text)[0])


def of_watch(folder):
    text = run(folder, "run", "p.toml", "--for", "2s", "--watch=" + ",".join(ROWS)).split("\nw (")[0]
    rows = re.findall(r"^(?:H\d+)?\s+(\S+)\s+(\S+)", text, re.M)
    return {name: number(value) for name, value in rows if name in ROWS}


def of_trace(folder):
    run(folder, "run", "p.toml", "--for", "2s", "--trace", "t.csv", "--signals", ",".join(f"u.{name}" for name in ROWS))
    with open(folder / "t.csv", newline="") as file:
        rows = list(csv.reader(file))
    head = [re.sub(r"^u\.|\s*[\[(].*?[\])]$", "", cell) if "lag" not in cell else "lag[1]" for cell in rows[0]]
    return {name: float(rows[-1][head.index(name)]) for name in ROWS}


def of_expectation(folder):
    text = 'plant = "p.toml"\n' + "".join(
        f'[[expect]]\nat = "2s"\nstation = "u"\nsignal = "{name}"\nequals = 123456\n' for name in ROWS)
    (folder / "n.test.toml").write_text(text)
    out = run(folder, "test", "n.test.toml")
    values = dict(re.findall(r": (\S+) of u is (-?\d+) at ", out))
    return {name: float(values[name]) for name in ROWS}


def of_debugger(folder):
    script = "until 2s\n" + "".join(f"print u.{name}\n" for name in ROWS) + "quit\n"
    out = run(folder, "debug", "p.toml", input=script)
    values = re.findall(r"^(?:\(\w+\) )*(?:.*= )?(-?\d+)(?: \((-?[\d.]+) ?(.*)\))?$", out, re.M)[-len(ROWS):]
    return {name: float(shown or value) for name, (value, shown, _) in zip(ROWS, values)}


def of_python(folder):
    with ipos.Plant(str(folder / "p.toml")) as plant:
        plant.run("2s")
        return dict(zip(ROWS, map(float, plant.reader(*(f"u.{name}" for name in ROWS))())))


def of_recording(folder):
    with ipos.Plant(str(folder / "p.toml")) as plant:
        plant.run("1.999s")
        recording = plant.record([f"u.{name}" for name in ROWS], "1ms")
        return {name: float(recording[f"u.{name}"][-1]) for name in ROWS}


def of_page(folder):
    sys.argv.insert(1, IPOS)  # as server_test.py is called
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "serve"))
    from server_test import Client
    server = subprocess.Popen([IPOS, "serve", "p.toml", "--port", "0"], cwd=folder, stdout=subprocess.PIPE, text=True)
    try:
        port, token = re.search(r":(\d+)/\?token=(\S+)", server.stdout.readline()).groups()
        client = Client(int(port), f"/ws?token={token}")
        for _ in range(20):
            client.ask(do="step", ms=100)
        names = [f"u.{name}" for name in ROWS]
        assert client.ask(do="watch", names=names)["ok"]
        client.ask(do="subscribe", topic="watch")
        event = client.wait_for("watch", lambda e: len(e["values"]) >= len(names))
        return {name: float(event["values"][f"u.{name}"]["value"]) for name in ROWS}
    finally:
        server.terminate()
        server.wait()


@pytest.mark.skipif(not IPOS, reason="the program is not named by IPOS")
@pytest.mark.parametrize("front_end", [of_watch, of_trace, of_expectation, of_debugger, of_python, of_recording, of_page],
                         ids=lambda way: way.__name__[3:])
def test_a_name_means_one_thing(folder, front_end):
    values = front_end(folder)
    assert {name: round(value) for name, value in values.items()} == ROWS


@pytest.mark.skipif(not IPOS, reason="the program is not named by IPOS")
def test_each_hidden_name_is_told_once(folder):
    out = subprocess.run([IPOS, "run", "p.toml", "--for", "10ms", "--why"], cwd=folder, capture_output=True, text=True)
    told = re.findall(r"'(\S+)' is a variable of the program, and hides", out.stdout + out.stderr)
    assert sorted(told) == ["DI03", "fault", "lag", "speed", "torque"]
