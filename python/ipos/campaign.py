"""Campaigns: many runs of a plant or of tests with other values (`ipos campaign`).

    import ipos.campaign

    rows = ipos.campaign.run("line.campaign.toml", out="results")
    rows = ipos.campaign.run("line.campaign.toml", out="results", executor=client.get_executor())

Each row is a dictionary: case, factors, measures, failed, hash. With an executor of concurrent.futures, or one of its kind (Dask,
mpi4py), each task runs one shard, so that whoever does the work needs `ipos` on its PATH and the same folders.
"""

from __future__ import annotations

import json
import subprocess
import tempfile
from concurrent.futures import Executor
from pathlib import Path
from typing import Any, Optional, Union

from ._program import find_program

_GOOD = (0, 1)  # 1: a case failed, which its row tells


class CampaignError(Exception):
    """What `ipos campaign` said when it could not do its work; `code` is its exit code."""

    def __init__(self, text: str, code: int) -> None:
        super().__init__(text)
        self.code = code


def _ipos(program: Optional[str], *arguments: str) -> str:
    found = program or find_program()
    if found is None:
        raise CampaignError("the program ipos is not on the PATH", 127)
    done = subprocess.run([found, "campaign", *arguments], capture_output=True, text=True)
    if done.returncode not in _GOOD:
        raise CampaignError(done.stderr.strip() or done.stdout.strip(), done.returncode)
    return done.stdout


def _run_shard(file: str, out: str, shard: str, program: Optional[str], more: list[str]) -> None:
    _ipos(program, "run", file, "--out", out, "--shard", shard, *more)


def run(
    file: Union[str, Path],
    out: Union[str, Path, None] = None,
    executor: Optional[Executor] = None,
    *,
    shards: int = 16,
    jobs: Optional[int] = None,
    program: Optional[str] = None,
) -> list[dict[str, Any]]:
    """Runs the cases that have no result in the folder `out` yet, and gives the rows of all in the order of the plan.

    Without `out` the results live in a folder for temporary files. `shards` are the tasks for the executor; `jobs` the cases at a
    time of each: one with an executor, else one a core. CampaignError: the file has mistakes, the disk is full ...
    """
    if out is None:
        with tempfile.TemporaryDirectory(prefix="ipos-campaign-") as folder:
            return run(file, folder, executor, shards=shards, jobs=jobs, program=program)
    path, folder = str(Path(file).resolve()), str(Path(out).resolve())
    more = ["--jobs", str(jobs)] if jobs is not None else ["--jobs", "1"] if executor is not None else []
    if executor is None:
        _run_shard(path, folder, "1/1", program, more)
    else:
        tasks = [executor.submit(_run_shard, path, folder, f"{n}/{shards}", program, more) for n in range(1, shards + 1)]
        for task in tasks:
            task.result()
    return [json.loads(line) for line in _ipos(program, "merge", folder, "--jsonl", "-").splitlines()]
