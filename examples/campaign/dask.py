#!/usr/bin/env python3
"""A campaign by Dask: dask.py FILE DIR SHARDS [SCHEDULER].

Without the address of a scheduler the workers are processes of this machine.
"""
import subprocess
import sys
from pathlib import Path

# Else this very file would be found in place of the package that has its name.
sys.path[:] = [path for path in sys.path if Path(path).resolve() != Path(__file__).resolve().parent]

import distributed  # noqa: E402

import ipos.campaign  # noqa: E402


def main():
    file, folder, shards = sys.argv[1:4]
    where = {"address": sys.argv[4]} if len(sys.argv) > 4 else {"processes": True, "dashboard_address": None}
    with distributed.Client(**where) as client:
        rows = ipos.campaign.run(file, out=folder, executor=client.get_executor(), shards=int(shards))
    print(f"{len(rows)} cases, {sum(bool(row['failed']) for row in rows)} failed")
    return subprocess.run(["ipos", "campaign", "merge", folder, "--csv", f"{folder}/results.csv"]).returncode


if __name__ == "__main__":
    sys.exit(main())
