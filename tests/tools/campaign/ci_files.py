#!/usr/bin/env python3
"""The files for GitLab and GitHub of examples/campaign do what they say: ci_files.py IPOS EXAMPLE.

Their YAML is read, and each job's commands run in a checkout of its own, as the servers run them, with the artifacts carried from job to
job. What comes out is what one run gives, to the byte. 77: there is no reader of YAML.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

try:
    import yaml
except ImportError:
    print("python3-yaml is not installed: skipped")
    sys.exit(77)

IPOS, EXAMPLE = Path(sys.argv[1]), Path(sys.argv[2])
CASES = 400  # of the million


class Ground:
    """Checkouts of a small campaign, and ipos on the PATH."""

    def __init__(self, root):
        self.root = root
        (root / "bin").mkdir()
        (root / "bin" / "ipos").symlink_to(IPOS)
        self.source = root / "source"
        self.source.mkdir()
        for file in [*EXAMPLE.glob("*.IPC"), *EXAMPLE.glob("*.toml")]:
            shutil.copy(file, self.source)
        campaign = self.source / "line.campaign.toml"
        text = campaign.read_text()
        small = text.replace("steps = 100", "steps = 4").replace('"1..100"', '"1..1"')
        assert small != text
        campaign.write_text(small)
        self.checkouts = 0

    def checkout(self):
        self.checkouts += 1
        folder = self.root / f"job-{self.checkouts}"
        shutil.copytree(self.source, folder)
        return folder

    def run(self, folder, shell, command, **variables):
        environment = {**os.environ, **variables, "PATH": f"{self.root / 'bin'}:{os.environ['PATH']}"}
        done = subprocess.run([*shell, command], cwd=folder, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, f"{command}: {done.returncode}\n{done.stdout}{done.stderr}"


def carry(source, target):
    """An artifact: a file or a folder, put beside what is there."""
    if source.is_dir():
        shutil.copytree(source, target, dirs_exist_ok=True)
    else:
        shutil.copy(source, target)


def gitlab(ground):
    jobs = yaml.safe_load((EXAMPLE / "gitlab.yml").read_text())
    shell = ["sh", "-ec"]
    kept = {}
    for name, job in jobs.items():
        assert isinstance(job["script"], list) and job["script"], name
        assert set(job) <= {"image", "parallel", "script", "artifacts", "needs"}, f"{name}: {set(job)}"
        assert all(need in jobs for need in job.get("needs", [])), name
        total = job.get("parallel", 1)
        results = []
        for index in range(1, total + 1):
            folder = ground.checkout()
            for need in job.get("needs", []):
                for other, paths in kept[need]:
                    for path in paths:
                        carry(other / path, folder / path)
            for command in job["script"]:
                ground.run(folder, shell, command, CI_NODE_INDEX=str(index), CI_NODE_TOTAL=str(total))
            paths = job["artifacts"]["paths"]
            for path in [*paths, *job["artifacts"].get("reports", {}).values()]:
                assert (folder / path).exists(), f"{name}: there is no artifact {path}"
            results.append((folder, paths))
        kept[name] = results
    return kept["report"][0][0] / "results.csv"


def github(ground):
    workflow = yaml.safe_load((EXAMPLE / "github.yml").read_text())
    assert workflow[True] == ["workflow_dispatch"]  # YAML 1.1 reads "on" as a word for true; GitHub does not
    stored = {}  # artifacts by name
    done = set()
    for name, job in workflow["jobs"].items():
        assert set(job) <= {"runs-on", "container", "strategy", "needs", "steps"}, f"{name}: {set(job)}"
        assert job.get("needs", name) in done | {name}, name
        shards = job.get("strategy", {}).get("matrix", {}).get("shard", [None])
        for shard in shards:
            folder = None

            def words(text):
                return re.sub(r"\$\{\{ *matrix\.shard *\}\}", str(shard), text)

            checked_out = any(step.get("uses", "").startswith("actions/checkout@") for step in job["steps"])
            folder = ground.checkout() if checked_out else Path(tempfile.mkdtemp(dir=ground.root))
            for step in job["steps"]:
                uses, given = step.get("uses", ""), step.get("with", {})
                if "run" in step:
                    command = words(step["run"])
                    assert "${{" not in command, command
                    if shard is not None:
                        assert f"/{len(shards)} " in command, f"{command}: the matrix has {len(shards)} shards"
                    ground.run(folder, ["bash", "-ec"], command)
                elif uses.startswith("actions/upload-artifact@"):
                    key = words(given["name"])
                    assert key not in stored, f"two artifacts are called {key}"
                    stored[key] = ground.root / f"artifact-{key}"
                    stored[key].mkdir()
                    for path in given["path"].split():
                        assert (folder / path).exists(), f"{name}: there is no artifact {path}"
                        carry(folder / path, stored[key])
                elif uses.startswith("actions/download-artifact@"):
                    for key, artifact in stored.items():
                        carry(artifact, folder / given["path"] / key)
                else:
                    assert uses.startswith("actions/checkout@"), f"{name}: {step}"
        done.add(name)
    return stored["report"] / "results.csv"


for engine in (gitlab, github):
    with tempfile.TemporaryDirectory() as held:
        ground = Ground(Path(held))
        alone = ground.checkout()
        ground.run(alone, ["sh", "-ec"], "ipos campaign run line.campaign.toml --out one || [ $? = 1 ]; ipos campaign merge one --csv one.csv")
        wanted = (alone / "one.csv").read_bytes()
        assert wanted.count(b"\n") == CASES + 1, wanted.count(b"\n")
        assert engine(ground).read_bytes() == wanted, engine.__name__
        print(f"{engine.__name__}: as one run")
