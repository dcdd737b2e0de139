"""A first look (preset demo) is configured, and each object that reads a precompiled header has the header's own optimiser
level: g++ refuses the header else, and nothing but ./dev demo would notice.
usage: first_look.py PROJECT"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

project = Path(sys.argv[1])
preset = next(row for row in json.loads((project / "CMakePresets.json").read_text())["configurePresets"] if row["name"] == "demo")
with tempfile.TemporaryDirectory() as build:
    subprocess.run(["cmake", "-S", project, "-B", build, "-G", "Ninja", "-DIPOS_TESTS=ON", "-DIPOS_QUICK_TESTS=ON",
                    *(f"-D{name}={value}" for name, value in preset["cacheVariables"].items())], check=True, capture_output=True)
    commands = json.loads((Path(build) / "compile_commands.json").read_text())
headers = [row for row in commands if "cmake_pch.hxx" in row["command"]]
assert len(headers) > 50, f"only {len(headers)} objects read a precompiled header"
wrong = [f"{row['file']}: {level}" for row in headers if (level := re.findall(r" -O\S+", row["command"])[-1].strip()) != "-O0"]
print("\n".join(wrong) or f"{len(headers)} objects, all with -O0")
sys.exit(bool(wrong))
