"""A small machine tested twice, by *.test.toml and in Python: on the machine as it is and on fifty with a planted mistake
both come to the same verdict."""

import os
import re
import subprocess
from pathlib import Path

import pytest

import ipos

PROGRAM = """#include <constb.h>
#include <iob.h>

// A press: DI10 orders a stroke. The ram goes down for 200 ms, presses for 100 ms, goes up for 150 ms. A stroke is counted
// when it has ended; while DI11 (the guard) is open nothing begins. Every fifth piece is taken out as a sample.
long lPhase;
long lLeft;
long lStrokes;
long lSamples;
long lRefused;
long lOrder;

main()
{
    while (1)
    {
        _Wait(10);
        if (lPhase == 0)
        {
            if (DI10 == 1 && lOrder == 0)
            {
                if (DI11 == 1)
                {
                    lPhase = 1;
                    lLeft = 20;
                }
                else
                {
                    lRefused = lRefused + 1;
                }
            }
        }
        else
        {
            lLeft = lLeft - 1;
            if (lLeft <= 0)
            {
                lPhase = lPhase + 1;
                if (lPhase == 2) { lLeft = 10; }
                if (lPhase == 3) { lLeft = 15; }
                if (lPhase > 3)
                {
                    lPhase = 0;
                    lStrokes = lStrokes + 1;
                    if (lStrokes % 5 == 0) { lSamples = lSamples + 1; }
                }
            }
        }
        lOrder = DI10;
    }
}
"""

PLANT = """[[station]]
name = "press"
unit = "mdxb"
program = "PRESS.IPC"
[station.parameters]
P610 = 16               # DI10 and DI11 are IPOS inputs
P611 = 16
P938 = 9
[station.inputs]
DI00 = 1
DI11 = 1
"""

# A stroke every second from 1 s on, six of them; the guard is open at the fourth order.
TOML = """plant = "press.toml"
[[step]]
at = "500ms"
station = "press"
input = "DI10"
pulse = 1
for = "100ms"
every = "1s"
times = 7
[[step]]
at = "3400ms"
station = "press"
input = "DI11"
set = 0
[[step]]
at = "3900ms"
station = "press"
input = "DI11"
set = 1
"""


# What is expected when: the two tests are written from this, each in its own words.
def expectations():
    times = {0: 0, 600: 1, 690: 1, 760: 2, 800: 2, 860: 3, 930: 3, 1050: 0, 1400: 0, 3700: 0, 4600: 1}
    for at, phase in times.items():
        yield at, "lPhase", phase
    for at, strokes in {400: 0, 1050: 1, 2050: 2, 3050: 3, 4050: 3, 5050: 4, 6050: 5, 7050: 6}.items():
        yield at, "lStrokes", strokes
    for at, samples in {5050: 0, 6050: 1, 7050: 1}.items():
        yield at, "lSamples", samples
    for at, refused in {3300: 0, 3700: 1, 7050: 1}.items():
        yield at, "lRefused", refused


def in_toml():
    rows = [
        f'[[expect]]\nat = "{at}ms"\nstation = "press"\nvariable = "{name}"\nequals = {value}\n'
        for at, name, value in sorted(expectations())
    ]
    return TOML + "".join(rows)


def in_python(folder):
    with ipos.Plant(folder / "press.toml") as plant:
        press = plant["press"]
        hands = [(500 + 1000 * n, "DI10", 1) for n in range(7)] + [(600 + 1000 * n, "DI10", 0) for n in range(7)]
        hands += [(3400, "DI11", 0), (3900, "DI11", 1)]
        # A step of a test acts before the ticks of its millisecond, a call behind those of the millisecond it has run to.
        hands = [(at - 1, name, level) for at, name, level in hands]
        looks = [(at, name, value) for at, name, value in expectations()]
        for at in sorted({at for at, *_ in hands} | {at for at, *_ in looks}):
            plant.run((at * 1000 - plant.time_us) / 1e6)
            for _, name, value in (each for each in looks if each[0] == at):
                assert press[name] == value, f"{name} at {at} ms"
            for _, name, level in (each for each in hands if each[0] == at):
                press.inputs[name] = level


# Fifty mistakes: a number, an operator, a name or a parameter that is another one.
def mistakes():
    swaps = {"==": "!=", "<=": "<", ">": ">=", "&&": "||", "+ 1": "- 1", "- 1": "+ 1", "%": "/"}
    found = []
    for number in re.finditer(r"(?<![\w.])\d+(?![\w.])", PROGRAM[PROGRAM.index("main()") :]):
        at = number.start() + PROGRAM.index("main()")
        for change in (1, -1):
            found.append((at, number.group(), str(int(number.group()) + change)))
    for old, new in swaps.items():
        for place in re.finditer(re.escape(old), PROGRAM[PROGRAM.index("main()") :]):
            found.append((place.start() + PROGRAM.index("main()"), old, new))
    for old, new in (("lStrokes = lStrokes", "lStrokes = lSamples"), ("lOrder = DI10", "lOrder = DI11")):
        found.append((PROGRAM.index(old), old, new))
    step = len(found) / 50
    return [found[int(n * step)] for n in range(50)]


def write(folder, program):
    (folder / "PRESS.IPC").write_text(program)
    (folder / "press.toml").write_text(PLANT)
    (folder / "press.test.toml").write_text(in_toml())


def verdict_of_toml(folder):
    run = subprocess.run([os.environ["IPOS"], "test", str(folder), "--jobs", "1"], capture_output=True, text=True, check=False)
    return run.returncode == 0, run.stdout + run.stderr


def verdict_of_python(folder):
    try:
        in_python(folder)
        return True, ""
    except (AssertionError, ipos.PlantError) as error:
        return False, str(error)


def test_the_machine_as_it_is(tmp_path):
    write(tmp_path, PROGRAM)
    assert verdict_of_toml(tmp_path) == (True, verdict_of_toml(tmp_path)[1])
    assert verdict_of_python(tmp_path) == (True, "")


def test_fifty_mistakes_get_the_same_verdict_twice(tmp_path):
    caught = 0
    for number, (at, old, new) in enumerate(mistakes()):
        folder = tmp_path / str(number)
        folder.mkdir()
        write(folder, PROGRAM[:at] + new + PROGRAM[at + len(old) :])
        (toml, said), (python, told) = verdict_of_toml(folder), verdict_of_python(folder)
        line = PROGRAM.count("\n", 0, at) + 1
        assert toml == python, f"line {line}: {old} -> {new}\ntoml: {said}\npython: {told}"
        caught += not toml
    assert caught >= 35, caught


if not os.environ.get("IPOS"):
    pytest.skip("IPOS names no program", allow_module_level=True)
assert Path(os.environ["IPOS"]).exists()
