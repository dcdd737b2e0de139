"""Wrong use of the package raises and never ends the interpreter: everything public is called with wrong types, with a
closed plant, and from other threads, in an interpreter of its own."""

import subprocess
import sys
import textwrap
from pathlib import Path

HERE = Path(__file__).resolve().parent

# What every part of these tests begins with: the objects of a plant, and what they can be asked for.
OBJECTS = '''
import faulthandler, gc, inspect, itertools, random, sys, threading
faulthandler.enable()
sys.path.insert(0, {package!r})
import ipos
from ipos import _library, bus, movilink, recording

LINE = {line!r}
SERIAL = """
[[bus]]
name = "rs"
kind = "rs485"
[[station]]
name = "a"
unit = "mdxb"
rs485 = "rs"
"""

class Odd:
    """Neither a text nor a number, with operators that fail."""
    def __bool__(self): raise ArithmeticError("neither true nor false")
    def __index__(self): raise ArithmeticError("no number")
    def __eq__(self, other): raise ArithmeticError("not comparable")
    __hash__ = None

WRONG = [None, True, -1, 0, 2**63, 2**64, -2**63, -2**70, 0.05, float("nan"), float("inf"), -1e300, "", "saw",
         "lCount", "saw.lCount", "P130", "x" * 70000, "a\\0b", "\\ud800", "5 V", b"", b"x" * 70000, bytearray(9), [], [1], ["saw.lCount"],
         (), {{}}, {{"a": 1}}, object(), Odd(), len, lambda *a, **k: None, range(3), Exception, ipos.Plant, 1j]

def ended(action):
    """Any exception is fine, as long as it is one."""
    try:
        result = action()
        if inspect.isgenerator(result):
            next(result, None)
        repr(result)
        return None
    except (Exception, SystemExit) as error:
        str(error)
        return error

def objects(plant, serial):
    saw = plant["saw"]
    plant.run("5ms")
    plant.buses["sbus"].send(1, b"x"); plant.run("5ms")
    frames = plant.buses["sbus"].frames()
    found = [plant, serial, saw, saw.parameters, saw.inputs, saw.outputs, saw.analog, saw.words, plant.buses["sbus"], plant.buses,
             serial.buses["rs"], plant.reader("saw.lCount"), plant.record(["saw.lCount"], "2ms"), saw.parameters["P130"],
             saw.analog["AI1"], frames[-1]]
    return found


def asks(one):
    """Names of what the package defines of an object; what begins with one underscore takes pointers of the library."""
    own = [each for each in type(one).__mro__ if each.__module__.startswith("ipos")]
    for name in dict.fromkeys(name for each in own for name in vars(each)):
        if callable(getattr(type(one), name)) or isinstance(getattr(type(one), name), property):
            if name not in ("__class__", "__del__") and (name.startswith("__") or not name.startswith("_")):
                yield name


def use(one, name, *arguments, **keys):
    attribute = getattr(one, name)
    return attribute(*arguments, **keys) if callable(attribute) else attribute

def signatures(one, name, rng):
    """Wrong arguments: every one alone, and random ones of two to four."""
    yield ()
    if isinstance(getattr(type(one), name or "__call__", None), property):
        return
    for wrong in WRONG:
        yield (wrong,)
    for _ in range(15):
        yield tuple(rng.choice(WRONG) for _ in range(rng.choice((2, 2, 3, 4))))
'''


def interpreter(script, folder):
    head = OBJECTS.format(package=str(HERE.parents[1] / "python"), line=str(HERE / "line.toml"))
    done = subprocess.run(
        [sys.executable, "-c", head + textwrap.dedent(script)], cwd=folder, capture_output=True, text=True, timeout=600
    )
    assert done.returncode == 0, f"the interpreter ended with {done.returncode}\n{done.stdout}\n{done.stderr[-4000:]}"
    return done.stdout


def test_every_function_with_wrong_arguments(tmp_path):
    out = interpreter("""
        rng = random.Random(1)
        count = 0
        plant, serial = ipos.Plant(LINE), ipos.Plant(text=SERIAL)
        for one in objects(plant, serial):
            for name in asks(one):
                if name in ("close", "__exit__", "__init__"):
                    continue
                for arguments in signatures(one, name, rng):
                    ended(lambda: use(one, name, *arguments))
                    count += 1
                    if plant.time > 0.5:  # a long time that was right: begin anew
                        plant.restore(ipos.Plant(LINE).snapshot())
        for maker in (ipos.Plant, ipos.Frame, ipos.Station, ipos.Bus, ipos.Mistake, recording.Reader, recording.Recording,
                      movilink.Sbus, movilink.Serial, movilink.Drive, movilink.scan, _library.duration_ns):
            for arguments in signatures(maker, "", rng):
                ended(lambda: maker(*arguments))
                count += 1
            for key in ("text", "folder", "include_dirs", "defines", "speed", "seed", "write_memory", "record"):
                for wrong in WRONG:
                    if maker is ipos.Plant and key != "text":
                        ended(lambda: ipos.Plant(text=SERIAL, **{key: wrong}))
                        count += 1
        assert plant["saw"] is not None
        plant.run("10ms")
        print(count)
    """, tmp_path)
    assert int(out.split()[-1]) > 2_000


def test_every_attribute_set_to_wrong_values(tmp_path):
    interpreter("""
        plant, serial = ipos.Plant(LINE), ipos.Plant(text=SERIAL)
        for one in objects(plant, serial):
            for name in asks(one):
                if isinstance(getattr(type(one), name, None), property):
                    for wrong in WRONG:
                        ended(lambda: setattr(one, name, wrong))
        plant.run("10ms")
    """, tmp_path)


def test_a_closed_plant_and_one_that_never_opened(tmp_path):
    interpreter("""
        rng = random.Random(2)
        plant, serial = ipos.Plant(LINE), ipos.Plant(text=SERIAL)
        found = objects(plant, serial)
        plant.close(); serial.close()
        found.append(ipos.Plant.__new__(ipos.Plant))
        for one in found:
            for name in asks(one):
                for arguments in itertools.islice(signatures(one, name, rng), 0, None, 3):
                    if name != "__init__":
                        ended(lambda: use(one, name, *arguments))
        assert isinstance(ended(lambda: plant.run("1ms")), ipos.ClosedError)
        for _ in range(3):
            plant.close()
    """, tmp_path)


def test_from_other_threads_while_it_runs(tmp_path):
    interpreter("""
        plant, serial = ipos.Plant(LINE), ipos.Plant(text=SERIAL)
        found = objects(plant, serial)
        stop = threading.Event()
        bad = []
        def others(seed):
            rng = random.Random(seed)
            while not stop.is_set():
                one = rng.choice(found)
                name = rng.choice(list(asks(one)))
                if name in ("adopt", "close", "__exit__", "__init__") or name.startswith("__"):
                    continue
                error = ended(lambda: use(one, name, *[rng.choice(WRONG) for _ in range(rng.randrange(3))]))
                if isinstance(error, SystemError):
                    bad.append(error)
        threads = [threading.Thread(target=others, args=(n,)) for n in range(4)]
        for thread in threads: thread.start()
        for _ in range(300):
            plant.run("10ms")
            plant["saw"]["lCount"]
        # Closing belongs to any thread, but not while a call is under way.
        closers = [threading.Thread(target=lambda: ended(plant.close)) for _ in range(4)]
        for thread in closers: thread.start()
        ended(lambda: plant.run("1s"))
        stop.set()
        for thread in threads + closers: thread.join()
        assert not bad, bad
        plant.close()
    """, tmp_path)


def test_closing_beside_calls_of_other_threads(tmp_path):
    out = interpreter("""
        sys.setswitchinterval(1e-6)
        late = 0  # plants that a call found closed while it was asked for again
        for _ in range(150):
            plant = ipos.Plant(LINE)
            saw, bus = plant["saw"], plant.buses["sbus"]
            together = threading.Barrier(5)
            ends, odd = [], []
            def ask(*calls):
                together.wait()
                for error in (ended(call) for _ in range(20) for call in calls):
                    (ends if isinstance(error, ipos.ClosedError) else odd).append(error)
            def close():
                together.wait()
                while isinstance(ended(plant.close), ipos.ThreadError):
                    pass
            calls = (lambda: plant.time, lambda: saw.why, lambda: saw.variables, lambda: bus.load, lambda: plant.journal)
            threads = [threading.Thread(target=ask, args=calls) for _ in range(2)]
            threads += [threading.Thread(target=close) for _ in range(2)]
            for thread in threads: thread.start()
            ask(*calls)
            for thread in threads: thread.join()
            assert all(error is None or isinstance(error, ipos.ThreadError) for error in odd), odd
            assert isinstance(ended(lambda: plant.time), ipos.ClosedError)
            late += bool(ends)
        print(late)
    """, tmp_path)
    assert int(out) > 0


def test_calls_within_a_callback_and_of_what_is_gone(tmp_path):
    interpreter("""
        plant = ipos.Plant(LINE)
        saw = plant["saw"]
        plant.run("20ms")
        # From a replay only reading is allowed; what the callback raises comes out, or the run goes on.
        reader = plant.reader("saw.lCount")
        real = recording.Reader.__call__
        tried = []
        def nosy(self):
            for wrong in (plant.close, lambda: plant.run("1ms"), plant.snapshot, lambda: plant.restore(b"x"), plant.adopt,
                          lambda: saw.force("lCount", 1), lambda: plant.replay(["saw.lCount"])):
                tried.append(ended(wrong))
            raise KeyboardInterrupt
        recording.Reader.__call__ = nosy
        try:
            plant.replay(["saw.lCount"])
            raise AssertionError("what is raised within comes out")
        except KeyboardInterrupt:
            pass
        recording.Reader.__call__ = real
        assert all(isinstance(each, ipos.PlantError) for each in tried[:6]), tried
        assert plant.time > 0
        # Conditions that do anything.
        for wrong in (plant.close, lambda: plant.restore(b""), lambda: sys.exit(1), lambda: plant.run(until=lambda: True)):
            ended(lambda: plant.run(until=wrong, limit="5ms"))
        # Parts outlive their plant, which is freed with the last one.
        other = ipos.Plant(LINE)
        part, words = other["belt"], other["belt"].words
        del other
        gc.collect()
        part.why, words["PO1"]
        del part, words
        gc.collect()
        # A buffer that changes its size while it is restored from.
        one = ipos.Plant(LINE)
        state = bytearray(one.snapshot())
        ended(lambda: one.restore(memoryview(state)))
        ended(lambda: one.restore(memoryview(state)[::2]))
    """, tmp_path)
