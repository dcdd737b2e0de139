"""A packed trace, read in Python: against the texts that the same run writes, and damaged in every byte."""
import json
import os
import subprocess
from pathlib import Path

import pytest

import ipos.trace

PROJECT = Path(__file__).resolve().parents[2]


def run(plant, *arguments):
    subprocess.run([os.environ["IPOS"], "run", str(PROJECT / plant), *arguments], check=False, capture_output=True)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    folder = tmp_path_factory.mktemp("trace")
    for form in ("csv", "jsonl", "ipos-trace"):
        run("examples/isync/isync.toml", "--for", "3s", "--trace", str(folder / f"a.{form}"), "--signals",
            "*.speed,*.status,*.H49*,sbus.frames")
    return folder


def test_it_has_what_the_csv_has(files):
    trace = ipos.trace.read(files / "a.ipos-trace")
    head, *rows = (files / "a.csv").read_text().splitlines()
    names = [name.split(" [")[0] for name in head.split(",")]
    assert names == ["time_ms", *trace.names, "sbus.frames"]
    assert not trace.ends_early and len(trace) == len(rows) == 3000
    columns = list(zip(*(row.split(",") for row in rows)))
    assert [round(time * 1000) for time in trace.times] == [int(text) for text in columns[0]]
    for name, texts in zip(trace.names, columns[1:]):
        assert trace[name] == pytest.approx([float(text) for text in texts], abs=1e-9), name
    frames = [text for cell in columns[-1] for text in cell.split("; ") if text]
    assert [frame.text for frame in trace.frames] == frames and len(frames) > 10


def test_its_events_and_frames_are_those_of_the_json_lines(files):
    trace = ipos.trace.read(files / "a.ipos-trace")
    lines = [json.loads(line) for line in (files / "a.jsonl").read_text().splitlines()]
    events = [(line["time_ms"], line["event"], line["fault"]) for line in lines if "event" in line]
    assert [(round(event.time * 1000), event.text, event.is_fault) for event in trace.events] == events and events
    frames = [(line["time_ms"], line["id"], line["data"]) for line in lines if "frame" in line]
    assert [(pytest.approx(frame.time * 1000, abs=1e-6), frame.id, frame.data.hex().upper()) for frame in trace.frames] == frames


def test_telegrams_have_their_words(tmp_path):
    for form in ("jsonl", "ipos-trace"):
        run("examples/movilink-rs485/rs485.toml", "--for", "1s", "--trace", str(tmp_path / f"a.{form}"), "--signals", "line1.frames")
    trace = ipos.trace.read(tmp_path / "a.ipos-trace")
    lines = [json.loads(line) for line in (tmp_path / "a.jsonl").read_text().splitlines()]
    told = [(line["data"], line["text"]) for line in lines if "frame" in line]
    assert [(frame.data.hex().upper(), frame.text) for frame in trace.frames] == told and told
    assert trace.frames[0].id is None and trace.frames[0].bus == "line1"


def test_of_a_killed_run_there_are_the_blocks_before(files, tmp_path):
    data = (files / "a.ipos-trace").read_bytes()
    whole = ipos.trace.read(files / "a.ipos-trace")
    lengths = set()
    for size in range(len(data) - 1, 20, -97):
        cut = tmp_path / "cut.ipos-trace"
        cut.write_bytes(data[:size])
        try:
            trace = ipos.trace.read(cut)
        except ipos.trace.TraceError as error:
            assert "before it says" in str(error)
            continue
        lengths.add(len(trace))
        assert trace.ends_early and trace.times == whole.times[: len(trace)]
        assert all(trace[name] == whole[name][: len(trace)] for name in whole.names)
    assert len(lengths) > 1


def test_damage_is_told_with_its_place(files, tmp_path):
    data = (files / "a.ipos-trace").read_bytes()
    path = tmp_path / "bad.ipos-trace"
    for at in list(range(0, 60)) + list(range(60, len(data), 211)):
        path.write_bytes(data[:at] + bytes([data[at] ^ 0x20]) + data[at + 1 :])
        try:
            assert ipos.trace.read(path).ends_early  # a length that leads behind the end
        except ipos.trace.TraceError as error:
            assert error.offset <= at and str(error).startswith(f"{path}: byte {error.offset}: ")
    path.write_text("time_ms,u.speed\n")
    with pytest.raises(ipos.trace.TraceError, match="this is no .ipos-trace"):
        ipos.trace.read(path)
