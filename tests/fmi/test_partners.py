"""Modelica's example FMUs of FMI-LS-BUS, built unchanged (modelica/fmi-ls-bus-examples: can-bus-simulation and
can-node-triggered-output). IPOS_LSBUS names the folder with DemoCanBusSimulation.fmu and DemoCanNodeTriggeredOutput.fmu."""

import os
from pathlib import Path

import pytest

from fmu import Fmu
from network import Ear, Network, Terminal
from test_network import check_watch_windows, line_alone, station_alone

FOLDER = os.environ.get("IPOS_LSBUS", "")
if not FOLDER:
    pytest.skip("IPOS_LSBUS names no folder with Modelica's example FMUs", allow_module_level=True)


def demo(name, folder):
    return Fmu(Path(FOLDER) / f"{name}.fmu", folder).make(events=True)


def test_two_stations_meet_by_modelicas_bus(tmp_path):
    one, two = (station_alone(f"unit{n}", tmp_path / str(n)) for n in (1, 2))
    bus = demo("DemoCanBusSimulation", tmp_path / "bus")
    Network((Terminal(one, "sbus"), Terminal(bus, "Node1")), (Terminal(two, "sbus"), Terminal(bus, "Node2"))).run(1.0)
    check_watch_windows(one, two)


def test_modelicas_node_on_our_line(tmp_path):
    """It sends 1 2 3 4 with the identifier 1 every 0.3 s at 100 kbit/s: 83 bits of 10 us, from the first one behind its step on."""
    node = demo("DemoCanNodeTriggeredOutput", tmp_path / "node")
    bus, ear = line_alone(tmp_path, 2), Ear()
    Network((Terminal(node, "CanChannel"), Terminal(bus, "sbus.node1")), (ear, Terminal(bus, "sbus.node2"))).run(1.0, grid=0.01)
    frame = bytes([0x10, 0, 0, 0, 20, 0, 0, 0, 1, 0, 0, 0, 0, 0, 4, 0, 1, 2, 3, 4])
    assert [data for _, data in ear.heard] == [frame] * 3
    assert [time for time, _ in ear.heard] == pytest.approx([0.3 * n + 84e-5 for n in (1, 2, 3)], abs=1e-9)
    confirmed = [text for text in node.told if "Set RX buffer of 12 bytes" in text]
    assert len(confirmed) == 3, "confirmations"


def test_two_of_modelicas_nodes_on_our_line(tmp_path):
    """Both send the same frame in the same moment, and a third node hears it once."""
    one, two = (demo("DemoCanNodeTriggeredOutput", tmp_path / str(n)) for n in (1, 2))
    bus, ear = line_alone(tmp_path, 3), Ear()
    Network((Terminal(one, "CanChannel"), Terminal(bus, "sbus.node1")), (Terminal(two, "CanChannel"), Terminal(bus, "sbus.node2")),
            (ear, Terminal(bus, "sbus.node3"))).run(1.0, grid=0.01)
    assert len(ear.heard) == 3
    assert bus.get("sbus.count") == 3
