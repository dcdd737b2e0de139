#!/usr/bin/env python3
"""The schemas of tools/vscode are what the readers of ipos say, and take all plants, tests and campaigns of the examples.

Usage: schema_test.py IPOS PROJECT
"""
import json
import subprocess
import sys
from pathlib import Path


def main():
    ipos, root = sys.argv[1], Path(sys.argv[2])
    schemas = root / "tools/vscode/schemas"
    made = subprocess.run([sys.executable, root / "tools/vscode/schema.py", ipos, schemas, "--check"], check=False)
    bad = made.returncode
    try:
        import jsonschema
        import tomllib
    except ImportError:
        print("the examples are not tried: there is no jsonschema or no tomllib here")
        return bad
    roots = {kind: json.loads((schemas / f"{kind}.schema.json").read_text()) for kind in ("plant", "test", "campaign")}
    files = jsonschema.RefResolver(schemas.as_uri() + "/", None)  # a test refers to tables of a plant
    validators = {kind: jsonschema.Draft7Validator(root, resolver=files) if kind == "test" else
                  jsonschema.Draft7Validator(root) for kind, root in roots.items()}
    taken = 0
    for path in sorted((root / "examples").rglob("*.toml")):
        kind = {".test": "test", ".campaign": "campaign"}.get(Path(path.stem).suffix, "plant")
        content = tomllib.loads(path.read_text())
        if kind == "plant" and "station" not in content:
            continue
        for error in validators[kind].iter_errors(content):
            print(f"{path}: {list(error.path)}: {error.message[:200]}")
            bad = 1
        taken += 1
    # What no reader takes no schema takes.
    for wrong in ('[[station]]\nname = "a"\nunit = "md60b"\n', '[[station]]\nname = 5\nunit = "md60a"\n',
                  '[[buss]]\n', '[[bus]]\nname = "b"\n', '[[station]]\nname = "a"\nunit = "md60a"\nspeed = 1\n'):
        if validators["plant"].is_valid(tomllib.loads(wrong)):
            print(f"the schema takes {wrong!r}")
            bad = 1
    print(f"{taken} plants and tests")
    return bad or (taken < 20)


if __name__ == "__main__":
    sys.exit(main())
