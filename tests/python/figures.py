"""What calls from Python cost, beside `ipos run` of the same plant: `python3 figures.py [STEPS]` prints it. The library is
that of IPOS_PLANT_LIBRARY or of build/release, the program that of IPOS or of build/release. Not a test."""

import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))

import ipos  # noqa: E402

LINE = str(Path(__file__).resolve().parent / "line.toml")
NAMES = [f"saw.{name}" for name in ("lCount", "lFalls", "lLevel", "H429", "H430", "H431", "speed", "position", "DI03", "DO01")]


PROGRAM = os.environ.get("IPOS", str(Path(__file__).resolve().parents[2] / "build/release/tools/ipos"))


def of_ipos_run(path, seconds, *options):
    """Simulated seconds a second of `ipos run`, without the time it takes to begin."""

    def wall(duration):
        begin = time.perf_counter()
        subprocess.run([PROGRAM, "run", path, "--for", duration, *options], check=True, stdout=subprocess.DEVNULL)
        return time.perf_counter() - begin

    return seconds / max(wall(f"{seconds}s") - min(wall("1ms") for _ in range(3)), 1e-9)


def clock(action, count):
    begin = time.perf_counter()
    for _ in range(count):
        action()
    return count / (time.perf_counter() - begin)


def steps():
    with ipos.Plant(LINE, record=False) as plant:
        saw, read = plant["saw"], plant.reader(*NAMES)

        def one_by_one():
            plant._run_to(plant._now() + 1_000_000)
            for name in ("lCount", "lFalls", "lLevel", "H429", "H430", "H431"):
                saw[name]
            saw.speed, saw.position, saw.inputs["DI03"], saw.outputs["DO01"]

        def bulk():
            plant._run_to(plant._now() + 1_000_000)
            read()

        print(f"one value read:                    {clock(lambda: saw['lCount'], 100_000):10.0f} a second")
        print(f"ten values read in one call:       {clock(read, 100_000):10.0f} a second")
        print(f"steps of 1 ms alone:               {clock(lambda: plant.run(0.001), 5000):10.0f} a second")
        print(f"... with ten values one by one:    {clock(one_by_one, 5000):10.0f} a second")
        print(f"... with ten values in one call:   {clock(bulk, 5000):10.0f} a second")
        begin = time.perf_counter()
        plant.run("60s")
        read()
        print(f"60 s in one call:                  {60 / (time.perf_counter() - begin):10.0f} simulated seconds a second")
    print(f"ipos run, machine code:            {of_ipos_run(LINE, 600):10.0f} simulated seconds a second")
    print(f"ipos run, the library's engine:    {of_ipos_run(LINE, 600, '--engine', 'fast'):10.0f} simulated seconds a second")


def write_drives(folder, count):
    """Drives of the saw's program on one SBus, each with an identifier of its own: 640 frames a second of 64."""
    program = (Path(LINE).parent / "SAW.IPC").read_text()
    rows = ['[[bus]]\nname = "sbus"\nkind = "can"\nbaud = 500000\n']
    for number in range(count):
        (folder / f"D{number}.IPC").write_text(program.replace("1024", str(1024 + number)))
        rows.append(
            f'[[station]]\nname = "d{number}"\nunit = "mdxb"\nprogram = "D{number}.IPC"\nsbus = "sbus"\n'
            f"[station.parameters]\nP813 = {number}\nP815 = 0\nP938 = 9\n"
            "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n"
        )
    (folder / "drives.toml").write_text("".join(rows))
    return str(folder / "drives.toml")


def drives(count, seconds):
    def clock_of_run(action):
        begin = time.perf_counter()
        action()
        return seconds / (time.perf_counter() - begin)

    def step_by_step(look):
        for _ in range(round(seconds * 1000)):
            plant.run(0.001)
            look()

    with tempfile.TemporaryDirectory() as folder:
        path = write_drives(Path(folder), count)
        with ipos.Plant(path, record=False) as plant:
            read = plant.reader(*[f"d{number}.lCount" for number in range(count)])
            plant.run(seconds)
            alone = clock_of_run(lambda: (plant.run(seconds), read()))  # units execute what is asked for
            stepped = clock_of_run(lambda: (step_by_step(lambda: None), read()))
            with_values = clock_of_run(lambda: step_by_step(read))
            counts = read()
            assert all(count > 90 * seconds * 4 for count in counts), counts  # each runs, and counts every 10 ms
        tool = of_ipos_run(path, 10 * seconds, "--engine", "fast")
    print(
        f"{count} drives, simulated seconds a second: {alone:.2f} in one call, {stepped:.2f} stepped each ms, "
        f"{with_values:.2f} with a value of each read; {tool:.2f} by ipos run"
    )


def growth(count):
    with ipos.Plant(LINE, record=False) as plant:
        read = plant.reader(*NAMES)
        sizes = []
        for n in range(count):
            plant._run_to(plant._now() + 1_000_000)
            read()
            if n % (count // 10) == count // 10 - 1:
                plant.buses["sbus"].frames()
                sizes.append(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    print(f"{count} steps: {sizes[0]} KB after a tenth, {sizes[-1]} KB at the end")


if __name__ == "__main__":
    steps()
    drives(64, 1.0)
    growth(int(sys.argv[1]) if len(sys.argv) > 1 else 100_000)
