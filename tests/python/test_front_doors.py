"""The plainest receiving programs come to the same end by every way in which people run them, as with --no-skip. Each way has a
process of its own with a limit of processor time, so a hang is a failed test on a loaded machine, too."""

import json
import os
import re
import resource
import subprocess
import sys

import pytest

from conftest import HERE, PACKAGE

IPOS = os.environ["IPOS"]
SECONDS = 3  # virtual
MOST_CPU = 20  # s; what is tried needs less than one
HEAD = ("#include <constb.h>\n#pragma globals 320 399\n"
        "SCTRCYCL Tr; SCREC Re; long t1; long t2; long r1; long r2;\nlong b; long n; long old;\n")
NAMES = ("t1", "r1", "b", "n", "old")
READERS = {
    "plainest": "b = r1;",
    "peak": "if (r1 > b) b = r1;",
    "edges": "if ((r1 & 1) && !old) n = n + 1; old = r1 & 1;",
    "counts": "if (r1 != old) { old = r1; n = n + 1; }",
    "waits": "while (r1 == old); old = r1; n = n + 1;",
    "forwards": "t1 = r1;",
}
SENDERS = {"fast": "t1 = t1 + 1;", "slow": "t1 = t1 + 1; _Wait(7);"}


def sends(number):
    return f"Tr.ObjectNo = {number}; Tr.CycleTime = 10; Tr.Format = 8; Tr.DPointer = numof(t1); _SBusCommDef(SCD_TRCYCL, Tr);\n"


@pytest.fixture(params=SENDERS)
def plant(request, tmp_path):
    text = '[[bus]]\nname = "can"\nkind = "can"\nbaud = 500000\n'
    bodies = {"sender": sends(1100) + f"_SBusCommOn(); while (1) {{ {SENDERS[request.param]} }}"}
    for n, (name, loop) in enumerate(READERS.items()):
        define = "Re.ObjectNo = 1100; Re.Format = 8; Re.DPointer = numof(r1); _SBusCommDef(SCD_REC, Re);\n"
        bodies[name] = define + (sends(1101 + n) if name == "forwards" else "") + f"_SBusCommOn(); while (1) {{ {loop} }}"
    for n, (name, body) in enumerate(bodies.items()):
        (tmp_path / f"{name}.IPC").write_text(f"{HEAD}main() {{ {body} }}\n")
        unit, address = (("mdxb", "P881"), ("md60a", "P813"))[n % 2]
        text += f'[[station]]\nname = "{name}"\nunit = "{unit}"\nprogram = "{name}.IPC"\nsbus = "can"\n'
        text += f"[station.parameters]\n{address} = {n + 1}\n"
    (tmp_path / "plant.toml").write_text(text)
    return tmp_path


def limited():
    resource.setrlimit(resource.RLIMIT_CPU, (MOST_CPU, MOST_CPU))


def output(folder, *command, text=""):
    done = subprocess.run(command, cwd=folder, input=text, capture_output=True, text=True, preexec_fn=limited)
    end = f"{done.returncode} (negative: it does not come to an end)"
    assert done.returncode == 0, f"{end} {done.stdout[-500:]}{done.stderr[-500:]}"
    return done.stdout


def run(folder, *more, until=f"{SECONDS}s"):
    said = output(folder, IPOS, "run", "plant.toml", "--for", until, "--watch", "--format", "json", *more)
    return {(station["name"], row["name"]): row["value"]
            for station in json.loads(said)["stations"] for row in station["variables"] if row["name"] in NAMES}


@pytest.fixture
def expected(plant):
    values = run(plant, "--no-skip")
    assert len(values) == len(NAMES) * (len(READERS) + 1)
    assert values["counts", "n"] > 100 and values["waits", "n"] > 100
    return values


def test_run(plant, expected):
    assert run(plant) == expected


def test_test(plant, expected):
    text = 'plant = "plant.toml"\n'
    for (station, name), value in expected.items():
        text += f'[[expect]]\nat = "{SECONDS}s"\nstation = "{station}"\nvariable = "{name}"\nequals = {value}\n'
    (plant / "all.test.toml").write_text(text)
    assert "1 passed" in output(plant, IPOS, "test", "all.test.toml")


def test_python(plant, expected):
    program = ("import ipos, json, sys\nwith ipos.Plant('plant.toml') as plant:\n"
               f"    plant.run('{SECONDS}s')\n"
               "    json.dump([plant[station][name] for station, name in json.loads(sys.argv[1])], sys.stdout)\n")
    values = json.loads(output(plant, "env", f"PYTHONPATH={PACKAGE}", sys.executable, "-c", program, json.dumps(list(expected))))
    assert dict(zip(expected, values)) == expected


def test_debug(plant, expected):
    words = "".join(f"print {station}.{name}\n" for station, name in expected)
    said = output(plant, IPOS, "debug", "plant.toml", "--for", f"{SECONDS}s", text=f"continue\n{words}quit\n")
    rows = re.findall(r"^(?:.*\) )?(\w+)\.(\w+) = (-?\d+)$", said, re.M)
    values = {(station, name): int(value) for station, name, value in rows}
    assert values == expected


def test_serve_as_fast_as_it_can(plant, monkeypatch):
    monkeypatch.setattr(sys, "argv", [sys.argv[0], IPOS])
    monkeypatch.syspath_prepend(str(HERE.parent / "serve"))
    from server_test import Client
    with subprocess.Popen([IPOS, "serve", "plant.toml"], cwd=plant, stdout=subprocess.PIPE, text=True, preexec_fn=limited,
                          env={**os.environ, "XDG_STATE_HOME": str(plant)}) as server:
        try:
            port, token = re.search(r":(\d+)/\?token=(\w+)", server.stdout.readline()).groups()
            client = Client(int(port), f"/ws?token={token}")
            names = [f"{station}.{name}" for station in ("sender", *READERS) for name in NAMES]
            assert "error" not in client.ask(do="watch", names=names)
            client.ask(do="run", speed=0)
            client.wait_for("time", lambda event: event["us"] >= SECONDS * 1_000_000)
            client.ask(do="pause")
            at = client.wait_for("time", lambda event: not event["running"])["us"]
            client.ask(do="subscribe", topic="watch")
            values = {}
            while len(values) < len(names):
                values.update(client.wait_for("watch")["values"])
            client.close()
        finally:
            server.terminate()
    expected = run(plant, "--no-skip", until=f"{at}us")
    assert {tuple(name.split(".")): value["value"] for name, value in values.items()} == expected
