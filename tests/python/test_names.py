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
    values = re.findall(r"^(?:\(\w+\) )*(?:\S+ = )(-?[\d.]+)(?: \((-?[\d.]+).*\))?", out, re.M)
    return {name: float(shown or value) for name, (value, shown) in zip(ROWS, values, strict=True)}


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
    sys.argv.insert(1, IPOS)  # as client.py wants it
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "serve"))
    from client import Client
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


# --- every group of names, in every front end that can look at it ---

GROUPS_PLANT = """
[[bus]]
name = "dp"
kind = "profibus"
[[bus]]
name = "can"
kind = "can"
[[station]]
name = "u"
unit = "mdxb"
program = "V.IPC"
[station.parameters]
P160 = "300 rpm"
[station.inputs]
DI03 = 1
[station.analog]
AI1 = "2.5 V"
[[station]]
name = "fan"
unit = "mc07"
sbus = "can"
[station.parameters]
P813 = 5
P100 = 10
P101 = 3
P815 = 0
[[station]]
name = "g"
unit = "gateway"
profibus = "dp"
profibus_address = 10
sbus = "can"
[[control]]
name = "plc"
profibus = "dp"
[[control.slave]]
address = 10
cfg = "F2"
po = [4, 1500, 7]
"""
GROUPS_PROGRAM = """
#include <const.h>
long lCount;
SCTRCYCL TrCycl;
main()
{
    lCount = 7;
    TrCycl.ObjectNo = 1024;
    H200 = 12;
    while (1) { }
}
"""
# None: whatever it is, it is the same everywhere. Telegrams belong to no station.
GROUP_ROWS = {
    "u.lCount": 7,
    "u.TrCycl.ObjectNo": 1024,
    "u.H200": 12,
    "u.ActPos_Mot": 0,
    "u.DI03": 1,
    "u.DI05": 0,
    "u.DB00": None,
    "u.DO01": None,
    "u.AI1": 2.5,
    "u.powered": 1,
    "u.running": 1,
    "u.program_fault": 0,
    "u.speed": 0,
    "u.status": None,
    "u.PO1": 0,
    "u.PI1": None,
    "u.P160": 300,
    "u.task1.state": 1,
    "u.task2.state": 0,
    "g.powered": 1,
    "g.exchange": 1,
    "g.drive5.PO2": 1500,
    "fan.PO2": 1500,
    "can.02B.PO2": 1500,
    "dp.10.PO2": 1500,
}
LINES = ("can.", "dp.")


@pytest.fixture(scope="module")
def groups(tmp_path_factory):
    folder = tmp_path_factory.mktemp("groups")
    (folder / "p.toml").write_text(GROUPS_PLANT)
    (folder / "V.IPC").write_text(GROUPS_PROGRAM)
    return folder


def groups_of_trace(folder):
    run(folder, "run", "p.toml", "--for", "2s", "--trace", "t.csv", "--signals", ",".join(GROUP_ROWS))
    with open(folder / "t.csv", newline="") as file:
        rows = list(csv.reader(file))
    head = [re.sub(r"\s*[\[(].*?[\])]$", "", cell) for cell in rows[0]]
    return {name: float(rows[-1][head.index(name)]) for name in GROUP_ROWS}


def groups_of_watch(folder):
    text = run(folder, "run", "p.toml", "--for", "2s", "--watch=" + ",".join(GROUP_ROWS))
    values, station = {}, ""
    for line in text.splitlines():
        if head := re.match(r"(\S+) \(", line):
            station = head[1] + "."
        elif line == "gateways and lines":
            station = ""
        elif row := re.match(r"(?:H\d+)?\s+(\S+)\s+(-?[0-9.]+)", line):
            values[station + row[1]] = float(row[2])
    return {name: values[name] for name in GROUP_ROWS}


def groups_of_expectation(folder):
    split = [name.split(".", 1) for name in GROUP_ROWS]
    owner = {name: "bus" if name.startswith(LINES) else "station" for name in GROUP_ROWS}
    (folder / "n.test.toml").write_text('plant = "p.toml"\n' + "".join(
        f'[[expect]]\nat = "2s"\n{owner[f"{of}.{name}"]} = "{of}"\nsignal = "{name}"\nequals = 123456\n' for of, name in split))
    out = run(folder, "test", "n.test.toml")
    values = {f"{station}.{name}": float(value)
              for name, station, value in re.findall(r": (\S+) of (\S+) is (-?\d+) at ", out)}
    return {name: values[name] for name in GROUP_ROWS}


def groups_of_debugger(folder):
    look = "".join(f"print {name}\n" for name in GROUP_ROWS if name.startswith(LINES))  # from now on
    script = "until 1s\n" + look + "until 2s\n" + "".join(f"print {name}\n" for name in GROUP_ROWS) + "quit\n"
    out = run(folder, "debug", "p.toml", input=script)
    found = re.findall(r"^(?:\(\w+\) )*(\S+) = (-?[\d.]+)(?: \((-?[\d.]+).*\))?", out, re.M)
    return {name: float(shown or value) for name, value, shown in found}


def groups_of_python(folder):
    with ipos.Plant(str(folder / "p.toml")) as plant:
        read = plant.reader(*GROUP_ROWS)  # lines keep telegrams from now on
        plant.run("2s")
        return dict(zip(GROUP_ROWS, map(float, read())))


def groups_of_page(folder):
    sys.argv.insert(1, IPOS)
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "serve"))
    from client import Client
    server = subprocess.Popen([IPOS, "serve", "p.toml", "--port", "0"], cwd=folder, stdout=subprocess.PIPE, text=True)
    try:
        port, token = re.search(r":(\d+)/\?token=(\S+)", server.stdout.readline()).groups()
        client = Client(int(port), f"/ws?token={token}")
        assert client.ask(do="watch", names=list(GROUP_ROWS))["ok"]
        client.ask(do="subscribe", topic="watch")
        client.wait_for("watch", lambda e: len(e["values"]) >= len(GROUP_ROWS))  # lines keep telegrams from now on
        for _ in range(20):
            client.ask(do="step", ms=100)
        assert client.ask(do="watch", names=list(GROUP_ROWS))["ok"]
        event = client.wait_for("watch", lambda e: len(e["values"]) >= len(GROUP_ROWS))
        return {name: float(event["values"][name]["value"]) for name in GROUP_ROWS}
    finally:
        server.terminate()
        server.wait()


GROUP_WAYS = [groups_of_trace, groups_of_watch, groups_of_expectation, groups_of_debugger, groups_of_python, groups_of_page]


@pytest.mark.skipif(not IPOS, reason="the program is not named by IPOS")
@pytest.mark.parametrize("front_end", GROUP_WAYS, ids=lambda way: way.__name__[10:])
def test_every_group_has_one_value(groups, front_end):
    agreed = groups_of_trace(groups)
    values = front_end(groups)
    for name, value in values.items():
        wanted = agreed[name] if GROUP_ROWS[name] is None else GROUP_ROWS[name]
        if front_end is groups_of_expectation:  # compares the number shown, rounded
            wanted = int(wanted + 0.5)
        assert value == pytest.approx(wanted), name


# What can be written, by every front end that writes; read back over the library or the same script.
WRITES = {"u.lCount": ("9", 9), "u.TrCycl.ObjectNo": ("17", 17), "u.H200": ("13", 13), "u.P160": ("450 rpm", 450),
          "u.DI05": ("1", 1), "u.PO1": ("6", 6)}


@pytest.mark.skipif(not IPOS, reason="the program is not named by IPOS")
def test_the_debugger_writes_every_group(groups):
    script = "until 100ms\n" + "".join(f"set {name} = {text}\n" for name, (text, _) in WRITES.items())
    script += "".join(f"print {name}\n" for name in WRITES) + "quit\n"
    out = run(groups, "debug", "p.toml", input=script)
    found = re.findall(r"^(?:\(\w+\) )*(\S+) = (-?[\d.]+)(?: \((-?[\d.]+).*\))?", out, re.M)
    values = {name: float(shown or value) for name, value, shown in found}
    assert values == {name: number for name, (_, number) in WRITES.items()}, out


def test_python_writes_every_group(groups):
    with ipos.Plant(str(groups / "p.toml")) as plant:
        plant.run("100ms")
        station = plant["u"]
        station["lCount"], station["TrCycl.ObjectNo"], station["H200"] = 9, 17, 13
        station.parameters["P160"] = "450 rpm"
        station.inputs["DI05"] = True
        station.words["PO1"] = 6
        values = dict(zip(WRITES, plant.reader(*WRITES)()))
    assert values == {name: pytest.approx(number) for name, (_, number) in WRITES.items()}


@pytest.mark.skipif(not IPOS, reason="the program is not named by IPOS")
def test_the_compiler_tells_a_hidden_name_in_a_note(folder):
    built = subprocess.run([IPOS, "build", "U.IPC", "--unit", "mdxb", "-Werror", "-o", "u.ipx"], cwd=folder,
                           capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    told = re.findall(r"note: '(\S+)' hides what the unit calls so.*\[N0219\]", built.stderr)
    assert sorted(told) == ["DI03", "fault", "lag", "speed", "torque"]
    assert "N0219" in run(folder, "explain", "N0219")
