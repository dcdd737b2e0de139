"""The table of third parties (third_parties.tsv), and which rows of it are in which file of a release."""

import csv
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COLUMNS = ["name", "version", "licence", "text", "found", "in", "home"]


def rows() -> list[dict]:
    with (ROOT / "packaging/third_parties.tsv").open() as table:
        lines = (line for line in table if not line.startswith("#"))
        read = csv.DictReader(lines, COLUMNS, delimiter="\t", quoting=csv.QUOTE_NONE)
        return [{**row, "found": row["found"].split(), "in": row["in"].split()} for row in read]


def contained(parts: list[str]) -> list[dict]:
    """The rows that are in one of the parts, names of the column `in`."""
    return [row for row in rows() if set(parts) & set(row["in"])]


def write_notices(parts: list[str], out: Path) -> None:
    subprocess.run(["cmake", f"-DIN={';'.join(parts)}", f"-DOUT={out}", "-P", ROOT / "cmake/notices.cmake"], check=True)
