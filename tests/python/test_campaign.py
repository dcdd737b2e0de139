"""Campaigns from Python: rows in the order of the plan, alone, in processes and in threads."""
import concurrent.futures
import os
from pathlib import Path

import pytest

import ipos.campaign

HERE = Path(__file__).parent
PLANT = f"""
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "saw"
unit = "mdxb"
program = "{HERE / "SAW.IPC"}"
sbus = "sbus"
"""
CAMPAIGN = """
plant = "saw.toml"
for = "100ms"
[[vary]]
station = "saw"
parameter = "P938"
values = [0, 5, 9]
[[vary]]
station = "saw"
variable = "H450"
from = 1
to = 4
steps = 4
[[measure]]
name = "h"
signal = "saw.H450"
take = "final"
"""


@pytest.fixture
def file(tmp_path):
    (tmp_path / "saw.toml").write_text(PLANT)
    path = tmp_path / "saw.campaign.toml"
    path.write_text(CAMPAIGN)
    return path


def program():
    return os.environ["IPOS"]


def test_rows_in_the_order_of_the_plan(file, tmp_path):
    rows = ipos.campaign.run(file, out=tmp_path / "out", program=program())
    assert [(row["factors"]["saw.P938"], row["factors"]["saw.H450"]) for row in rows] == [(a, b) for a in (0, 5, 9) for b in (1, 2, 3, 4)]
    assert all(row["measures"]["h"] == row["factors"]["saw.H450"] and row["failed"] == [] for row in rows)
    assert all(len(row["hash"]) == 16 for row in rows)


@pytest.mark.parametrize("kind", [concurrent.futures.ThreadPoolExecutor, concurrent.futures.ProcessPoolExecutor])
def test_any_executor_gives_the_same(file, tmp_path, kind):
    alone = ipos.campaign.run(file, program=program())
    with kind(max_workers=2) as executor:
        rows = ipos.campaign.run(file, out=tmp_path / "out", executor=executor, shards=3, program=program())
    assert rows == alone
    assert len(list((tmp_path / "out").glob("shard-*-of-3.jsonl"))) == 3


def test_mistakes_are_told(file):
    file.write_text("plant = 3\n")
    with pytest.raises(ipos.campaign.CampaignError) as found:
        ipos.campaign.run(file, program=program())
    assert found.value.code == 65
    assert "saw.campaign.toml:1:9: error:" in str(found.value)
