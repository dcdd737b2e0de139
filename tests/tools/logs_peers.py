#!/usr/bin/env python3
"""Logs in the hands of python-can and tshark, and theirs in ours; the dissector against `ipos bus decode`.

logs_peers.py IPOS SOURCE_DIR: every comparison is frame by frame, and field by field for the dissector.
"""
import json
import os
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

import can

IPOS, SOURCE = sys.argv[1], Path(sys.argv[2])
os.environ["TZ"] = "UTC"
EPOCH = 946684800


def run(*words, **more):
    done = subprocess.run(words, capture_output=True, text=True, **more)
    return done.stdout


def ours(log):
    done = subprocess.run([IPOS, "bus", "decode", log, "--format", "json"], capture_output=True, text=True)
    assert done.returncode == 0, f"{log}: {done.stderr}"
    return [json.loads(line) for line in done.stdout.splitlines()]


def key(row):
    return row["id"], row["extended"], row["remote"], row["data"]


def same(name, expected, got, exact_times=True):
    assert len(expected) == len(got), f"{name}: {len(expected)} frames became {len(got)}"
    for n, (a, b) in enumerate(zip(expected, got)):
        assert a[0] == b[0], f"{name}: frame {n} was {a} and is {b}"
        assert abs(a[1] - b[1]) < 2e-6, f"{name}: time of frame {n} was {a} and is {b}"
    print(f"{name}: {len(got)} frames the same")


def times(rows, first=None):
    first = float(rows[0]["time"]) if first is None else first
    return [(key(row), float(row["time"]) - first) for row in rows]


def of_can(messages):
    messages = list(messages)
    first = messages[0].timestamp
    return [
        ((m.arbitration_id, m.is_extended_id, m.is_remote_frame, "" if m.is_remote_frame else m.data.hex().upper()),
         m.timestamp - first)
        for m in messages
    ]


def written_by_us(folder):
    plant = SOURCE / "examples/movilink/movilink.toml"
    logs = {}
    for form in ("log", "pcapng", "asc", "trc"):
        path = str(folder / f"ours.{form}")
        run(IPOS, "run", str(plant), "--for", "400ms", "--log", path)
        logs[form] = path
    expected = times(ours(logs["log"]))
    assert len(expected) > 20
    for form in ("pcapng", "asc", "trc"):
        same(f"{form} read back", expected, times(ours(logs[form])))
    for form in ("log", "asc", "trc"):
        same(f"{form} in python-can", expected, of_can(can.LogReader(logs[form])))
    rows = run("tshark", "-r", logs["pcapng"], "-T", "fields", "-E", "separator=;", "-e", "frame.time_epoch", "-e",
               "can.id", "-e", "can.flags.xtd", "-e", "can.flags.rtr", "-e", "data.data")
    got = []
    for row in rows.splitlines():
        time, identifier, extended, remote, data = row.split(";")
        truth = ("1", "True")
        got.append(((int(identifier, 0), extended in truth, remote in truth, data.replace(":", "").upper()), float(time)))
    first = got[0][1]
    same("pcapng in tshark", expected, [(k, t - first) for k, t in got])
    rewritten = str(folder / "tshark.pcapng")
    run("tshark", "-r", logs["pcapng"], "-w", rewritten)
    same("pcapng written by tshark", expected, times(ours(rewritten)))


def error_frames(folder):
    """A trace of a disturbed line: its frames are those of the undisturbed forms for python-can, and its error frames are counted."""
    plant = folder / "disturbed.toml"
    plant.write_text((SOURCE / "examples/movilink/movilink.toml").read_text().replace('program = "', f'program = "{SOURCE}/examples/movilink/')
                     + '\n[[fault]]\nbus = "sbus"\nkind = "corrupt"\nrate = 300\n')
    logs = {form: str(folder / f"disturbed.{form}") for form in ("log", "trc")}
    for log in logs.values():
        run(IPOS, "run", str(plant), "--for", "400ms", "--log", log)
    same("disturbed trc in python-can", times(ours(logs["log"])), of_can(can.LogReader(logs["trc"])))
    count = sum(" ER " in row for row in Path(logs["trc"]).read_text().splitlines())
    told = sum(m.is_error_frame for m in can.LogReader(logs["log"]))
    assert count == told > 5, f"{count} error frames of {told}"
    print(f"disturbed trc: {count} error frames, as many as in the candump log")


def written_by_python_can(folder):
    draw = random.Random(7)
    messages = []
    for n in range(300):
        extended = draw.random() < 0.4
        length = draw.randrange(9)
        remote = draw.random() < 0.1
        messages.append(can.Message(
            timestamp=EPOCH + 1000 + n * 0.012345, channel=1, is_extended_id=extended, is_remote_frame=remote, dlc=length,
            arbitration_id=draw.randrange(1 << (29 if extended else 11)), is_rx=True,
            data=None if remote else draw.randbytes(length)))
    for form in ("log", "asc", "trc", "blf"):
        path = str(folder / f"theirs.{form}")
        # Its TRC writer knows no remote frames.
        logged = [m for m in messages if form != "trc" or not m.is_remote_frame]
        expected = of_can(logged)
        with can.Logger(path) as logger:
            for message in logged:
                logger(message)
        # The trace of python-can has tenths of a millisecond, and rounds its steps by itself.
        got = times(ours(path))
        if form == "trc":
            got = [(k, expected[n][1]) if abs(t - expected[n][1]) < 1e-3 else (k, t) for n, (k, t) in enumerate(got)]
        same(f"{form} of python-can", expected, got)
    # Each is known by its content and not by its name.
    blf = folder / "named.log"
    blf.write_bytes((folder / "theirs.blf").read_bytes())
    same("blf under another name", expected, times(ours(str(blf))))


def absolute_times(folder):
    """The date of its head is one for python-can. asc2log wants the locale en_US for dates, so there times count from the first."""
    log = str(folder / "date.asc")
    run(IPOS, "run", str(SOURCE / "examples/movilink/movilink.toml"), "--for", "400ms", "--log", log)
    expected = [(key(row), float(row["time"]) - EPOCH) for row in ours(log)]
    got = [((m.arbitration_id, m.is_extended_id, m.is_remote_frame, m.data.hex().upper()), m.timestamp - EPOCH)
           for m in can.ASCReader(log, relative_timestamp=False)]
    same("ASC with times of the clock in python-can", expected, got)
    rewritten = folder / "asc2log.log"
    rewritten.write_text(run("asc2log", "-I", log))
    from_first = [(k, t - expected[0][1]) for k, t in expected]
    same("ASC through asc2log", from_first, times(ours(str(rewritten))))
    back = folder / "log2asc.asc"
    back.write_text(run("log2asc", "-f", "-I", str(rewritten), "can0"))
    same("ASC of log2asc with lines of CAN FD", from_first, times(ours(str(back))))


def block(kind, body, order="<"):
    body += bytes(-len(body) % 4)
    return struct.pack(order + "II", kind, len(body) + 12) + body + struct.pack(order + "I", len(body) + 12)


def section(order="<"):
    return block(0x0A0D0D0A, struct.pack(order + "IHHq", 0x1A2B3C4D, 1, 0, -1), order)


def interface(link, options=(), order="<"):
    body = struct.pack(order + "HHI", link, 0, 0)
    for code, value in options:
        body += struct.pack(order + "HH", code, len(value)) + value + bytes(-len(value) % 4)
    return block(1, body + (struct.pack(order + "HH", 0, 0) if options else b""), order)


def packet(number, stamp, data, order="<"):
    return block(6, struct.pack(order + "IIIII", number, stamp >> 32, stamp & 0xFFFFFFFF, len(data), len(data)) + data, order)


def frame(identifier, flags=0, order=">"):
    return struct.pack(order + "I", identifier) + struct.pack("BBBB", 8, flags, 0, 0) + bytes(range(8))


def cooked(protocol, content):
    return struct.pack(">HHH8sH", 4, 280, 0, bytes(8), protocol) + content


def captured(folder):
    """Captures of other tools: units of time, byte orders, other interfaces and FD frames, as tshark reads them."""
    second = 1711000000
    stamp = second * 10**6 + 123456
    logs = {"plain": section() + interface(227) + packet(0, stamp, frame(0x203)) + packet(0, stamp + 5, frame(0x92345678)),
            "fd": section() + interface(227) + packet(0, stamp, frame(0x204, 4)) + packet(0, stamp, frame(0x203)),
            "ethernet": section() + interface(1) + interface(227) + packet(0, stamp, bytes(60)) + packet(1, stamp, frame(0x203)),
            "offset": section() + interface(227, [(14, struct.pack("<q", -3600))]) + packet(0, stamp, frame(0x203)),
            "old": section() + interface(227) + block(2, struct.pack("<HHIIII", 0, 0, stamp >> 32, stamp & 0xFFFFFFFF, 16, 16) + frame(0x203)),
            "any": section() + interface(113) + packet(0, stamp, cooked(0x0C, frame(0x203, 0, "<"))) + packet(0, stamp, cooked(0x0800, bytes(40))),
            "sections": section() + interface(227) + packet(0, stamp, frame(0x203)) + section(">") + interface(227, [(9, b"\x09")], ">") +
            packet(0, second * 10**9, frame(0x204), ">")}
    for resolution, time in ((0, second), (3, second * 1000 + 123), (9, second * 10**9 + 123456789), (12, 10**18 + 5 * 10**8),
                             (0x80 | 10, second << 10 | 512), (0x80 | 20, second << 20 | 1), (0x80 | 30, second << 30 | 1 << 29)):
        logs[f"resolution {resolution}"] = section() + interface(227, [(9, bytes([resolution]))]) + packet(0, time, frame(0x203))
    for order in "<>":
        for magic in (0xA1B2C3D4, 0xA1B23C4D):
            logs[f"pcap {order}{magic:X}"] = struct.pack(order + "IHHiIII", magic, 2, 4, 0, 0, 65535, 227) + b"".join(
                struct.pack(order + "IIII", second, 123456, 16, 16) + data for data in (frame(0x203), frame(0x204, 4), frame(0x92345678)))
    for name, content in logs.items():
        path = folder / "capture"
        path.write_bytes(content)
        rows = run("tshark", "-r", str(path), "-T", "fields", "-E", "separator=;", "-e", "frame.time_epoch", "-e", "can.id", "-e",
                   "can.flags.xtd", "-e", "_ws.col.Protocol", "-e", "data.data")
        expected = []
        for row in rows.splitlines():
            time, identifier, extended, protocol, data = row.split(";")
            if protocol == "CAN":
                expected.append(((int(identifier, 0), extended in ("1", "True"), False, data.replace(":", "").upper()), float(time)))
        assert expected, name
        same(f"capture '{name}' as in tshark", expected, [(key(row), float(row["time"])) for row in ours(str(path))])


def dissected(folder):
    """All examples in one pcapng: sections may follow each other."""
    lua = str(folder / "movilink.lua")
    run(IPOS, "bus", "dissector", "-o", lua)
    everything = folder / "all.pcapng"
    with open(everything, "wb") as out:
        for plant in sorted(SOURCE.glob("examples/*/*.toml")):
            if plant.name.endswith((".test.toml", ".campaign.toml")):
                continue
            log = folder / "one.pcapng"
            run(IPOS, "run", str(plant), "--for", "600ms", "--log", str(log))
            if log.exists():
                out.write(log.read_bytes())
    fields = ["telegram", "address", "group", "service", "handshake", "failed", "subindex", "index", "value", "error_class",
              "error_code", "error_additional", "po", "pi", "response", "type"]
    words = ["tshark", "-r", str(everything), "-X", f"lua_script:{lua}", "-d", "can.subdissector,movilink", "-T", "fields",
             "-E", "separator=;", "-E", "aggregator=,"]
    for field in fields:
        words += ["-e", f"movilink.{field}"]
    words += ["-e", "movilink.void"]
    done = subprocess.run(words, capture_output=True, text=True)
    assert "Lua Error" not in done.stdout + done.stderr and "lua" not in done.stderr, done.stderr
    lines = done.stdout.splitlines()
    rows = ours(str(everything))
    assert len(lines) == len(rows), (len(lines), len(rows))
    compared = 0
    kinds = set()
    for n, (line, row) in enumerate(zip(lines, rows)):
        values = dict(zip(fields + ["void"], line.split(";")))
        assert ("void" in row) == (values["void"] != ""), (n, row, values)
        for field in fields:
            text = values[field]
            if field not in row:
                # Without a plant the dissector knows no variable telegram either.
                assert text == "", (n, field, text, row)
                continue
            if isinstance(row[field], bool):
                got = text in ("1", "True")
            elif isinstance(row[field], list):
                got = [int(part, 0) for part in text.split(",")]
            elif field == "telegram":
                got = text
            else:
                got = int(text, 0)
            assert got == row[field], (n, field, text, row)
            compared += 1
        kinds.add(row.get("telegram", "RS-485" if "response" in row else "other"))
    assert compared > 1000 and len(kinds) >= 6, (compared, kinds)
    print(f"{len(rows)} telegrams, {compared} fields compared, differences 0: {', '.join(sorted(kinds))}")


with tempfile.TemporaryDirectory() as name:
    written_by_us(Path(name))
    error_frames(Path(name))
    written_by_python_can(Path(name))
    absolute_times(Path(name))
    captured(Path(name))
    dissected(Path(name))
