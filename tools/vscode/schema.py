#!/usr/bin/env python3
"""JSON schemas of plants, tests and campaigns, for editors without `ipos lsp`.

    schema.py IPOS FOLDER            writes plant.schema.json, test.schema.json and campaign.schema.json
    schema.py IPOS FOLDER --check    fails where they differ from what is there

A table that both files have in the same form stands in the $defs of plant.schema.json; test.schema.json refers to it.

Nothing is listed here: each table is shown to `ipos` with a key and values it cannot know, and what it says is known,
needed or wrong there is the schema. The parameters are those of `ipos param list`.
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROBE = "ipos_probe"
VALUES = {"string": f'"{PROBE}"', "integer": "7", "number": "7.5", "boolean": "true", "array": "[7]"}
BUS = '[[bus]]\nname = "b"\nkind = "profibus"\nbaud = 500000\n'
STATION = '[[station]]\nname = "s"\nunit = "md60a"\n'
CAMPAIGN_PLANT = "of_campaign.toml"
# Of texts that no probe is: "2 %", "1..100", "1s". The last two a fault has in a campaign only, beside what its reader knows.
CAMPAIGN_KEYS = {"band": {"type": ["number", "string"]}, "seeds": {"type": ["array", "string"]}, "at": {"type": ["array", "string"]}}
SIGNALS = {"variable": "H0", "parameter": "P130", "input": "DI00", "analog": "AI1", "switch": "fms_switch", "signal": "load_torque",
           "mains": "off"}


class Reader:
    """What ipos says of a text, by line."""

    ENDINGS = {"plant": "toml", "test": "test.toml", "campaign": "campaign.toml"}

    def __init__(self, ipos, folder, kind):
        self.ipos, self.kind, self.file = ipos, kind, Path(folder) / f"p.{self.ENDINGS[kind]}"
        self.test = kind == "test"
        (Path(folder) / CAMPAIGN_PLANT).write_text(f'{BUS}[[bus]]\nname = "c"\nkind = "can"\n{STATION}')

    def errors(self, text):
        self.file.write_text(text)
        how = {"plant": ["run", self.file, "--for", "1ms"], "test": ["test", self.file], "campaign": ["campaign", "plan", self.file]}[self.kind]
        out = subprocess.run([self.ipos, *how], capture_output=True, text=True, cwd=self.file.parent)
        found = re.findall(r"^\S+\.toml:(\d+):\d+: error: (.*)$", out.stdout + out.stderr, re.M)
        return [(int(line), message) for line, message in found]


def known(messages):
    for message in messages:
        if match := re.search(r"; known are (.+)$", message):
            return match[1].split(", ")
    return []


def units(ipos):
    """All unit types, as ipos names them where one is not known."""
    out = subprocess.run([ipos, "param", "list", "--unit", PROBE], capture_output=True, text=True)
    return known(out.stderr.splitlines())


def merged(a, b):
    """What is right where one of the two is."""
    if a == b:
        return a
    if "enum" in a and "enum" in b:
        return {"enum": a["enum"] + [word for word in b["enum"] if word not in a["enum"]]}
    if a.get("type") == b.get("type") == "array" and "items" in a and "items" in b:
        return {**a, "items": merged(a["items"], b["items"])}
    if "properties" in a and "properties" in b:
        both = dict(a["properties"])
        for key, value in b["properties"].items():
            both[key] = merged(both[key], value) if key in both else value
        out = {**a, "properties": dict(sorted(both.items()))}
        out.pop("required", None)
        needed = [key for key in a.get("required", []) if key in b.get("required", [])]
        return {**out, "required": needed} if needed else out
    if set(a) == set(b) == {"type"} and "array" not in (a["type"], b["type"]):
        kinds = {kind for one in (a, b) for kind in ([one["type"]] if isinstance(one["type"], str) else one["type"])}
        return {"type": sorted(kinds)}
    return {}


class Table:
    """A table of the file, in all forms it has: its keys differ with the kind of bus, control or step."""

    def __init__(self, reader, name, forms, before="", many=True):
        self.reader, self.name, self.before, self.many = reader, name, before, many
        self.forms = forms  # rows that stand in it
        self.keys = {}
        self.required = None

    def head(self):
        return f"[[{self.name}]]" if self.many else f"[{self.name}]"

    def needs(self):
        head = r"an? \[\[\w+\]\]" if self.many else re.escape(self.head())
        return head + r" needs (\w+) = (?!.*, or )"  # of two that will do, none is required

    def ask(self, form, row):
        text = self.before + self.head() + "\n" + form + row + "\n"
        line = text.count("\n")
        return [message for at, message in self.reader.errors(text) if at == line]

    def schema(self):
        for form in self.forms:
            keys = known(self.ask(form, f"{PROBE} = 1"))
            if self.reader.kind == "campaign" and self.name == "fault":
                keys += ["name", "seeds", "at"]
            needs = set()
            for _, message in self.reader.errors(self.before + self.head() + "\n" + form):
                if match := re.search(self.needs(), message):
                    needs.add(match[1])
            needs |= {row.split(" ")[0] for row in form.split("\n") if row and "kind" not in row}
            if self.name in ("stimulus", "step"):
                needs -= set(SIGNALS)
            if self.name == "vary":
                needs -= {"values"}  # or from, to and steps
            self.required = needs if self.required is None else self.required & needs
            for key in keys:
                value = self.value(form, key)
                self.keys[key] = merged(self.keys[key], value) if key in self.keys else value
        out = {"type": "object", "additionalProperties": False, "properties": dict(sorted(self.keys.items()))}
        if self.required and (needed := sorted(self.required & set(self.keys))):
            out["required"] = needed
        return out

    def value(self, form, key):
        if key in CAMPAIGN_KEYS and self.reader.kind == "campaign":
            return CAMPAIGN_KEYS[key]
        form = "".join(row + "\n" for row in form.split("\n") if row and not row.startswith(key + " "))
        if (self.name, key) == ("expect", "equals"):
            form += 'signal = "AO1"\n'  # whose values have decimals
        said = {kind: self.ask(form, f"{key} = {value}") for kind, value in VALUES.items()}
        if any("write [[" in message for message in said["integer"]):
            return {"type": "array", "items": Table(self.reader, f"{self.name}.{key}", self.nested(key),
                                                    self.before + self.head() + "\n" + form).schema()}
        if any("write [" in message for message in said["integer"]):
            return self.subtable(key)
        # A complaint that three kinds of values share is about the kind.
        shared = [list(messages) for messages in said.values()]
        good = [kind for kind, messages in said.items() if not messages or shared.count(list(messages)) < 3]
        if "array" in good and "string" not in good:
            good = ["array"]
        if not good:
            listed = any("list" in message for message in said["integer"])
            return {"type": "array", "items": {"type": "string"}} if listed else {}
        if len(good) == len(VALUES):
            return {}
        if "number" in good:
            good = [kind for kind in good if kind != "integer"]
        if good == ["string"]:
            words = known([message for message in said["string"] if PROBE in message])
            if words:
                return {"enum": words}
        return {"type": good[0] if len(good) == 1 else sorted(good)}

    def nested(self, key):
        return [""]

    def subtable(self, key):
        if self.name == "machine":  # its keys are those of an FMU
            kinds = ["boolean", "number"] if key == "parameters" else "string"
            return {"type": "object", "additionalProperties": {"type": kinds}}
        forms = ['kind = "conveyor"\n'] if key == "machine" else [""]  # the kind that takes all keys
        table = Table(self.reader, f"{self.name}.{key}", forms, self.before + self.head() + "\n", many=False)
        found = table.schema() if known(table.ask("", f"{PROBE} = 1")) else None
        if key == "parameters":
            return {"type": "object", "properties": parameters(self.reader.ipos), "patternProperties": {
                "^P?[0-9]+$": {"type": ["string", "integer", "boolean"]}}, "additionalProperties": False}
        if key == "inputs":
            return {"type": "object", "patternProperties": {
                # A test with cases may have the value of the case: "$di10".
                "^DI[01][0-7]$": {"anyOf": [{"enum": [0, 1, False, True]}, {"type": "string", "pattern": r"^\$\w+$"}]}},
                "additionalProperties": False}
        return found or {"type": "object"}


def parameters(ipos):
    names = {}
    for unit in units(ipos):
        out = subprocess.run([ipos, "param", "list", "--unit", unit, "--format", "json"], capture_output=True, text=True)
        for row in json.loads(out.stdout)["parameters"]:
            names.setdefault(row["number"], row["name"])
    return {number: {"description": name, "type": ["string", "integer", "boolean"]}
            for number, name in sorted(names.items())}


def forms_of(reader, key):
    """Rows with which a table is of another form than without."""
    forms = [""]
    if reader.kind == "campaign":
        forms = {"vary": [f'{row}\n' for row in ('station = "s"\nparameter = "P130"', 'station = "s"\nvariable = "H0"', 'key = "bus.b.baud"')],
                 "measure": [f'signal = "s.speed"\ntake = "{take}"\n' for take in ("max", "settling", "time")],
                 "fault": ['bus = "b"\n', 'bus = "c"\n']}[key]
        return forms, f'plant = "{CAMPAIGN_PLANT}"\n'
    if key == "station":
        forms = [f'unit = "{unit}"\n' for unit in units(reader.ipos)]
    if key == "stimulus":
        forms = [f'{kind} = "{name}"\n' for kind, name in SIGNALS.items()]
    if key == "control":
        forms += ['kind = "canopen"\n', 'profibus = "b"\n', 'kind = "fms"\nprofibus = "b"\n']
    if key == "fault":
        forms += ['bus = "b"\n']
    if key == "step":
        messages = [message for _, message in reader.errors(STATION + "[[step]]\n")]
        forms = [f'{word} = "{SIGNALS.get(word, PROBE)}"\n' for message in messages if "[[step]] needs one of" in message
                 for word in message.split("one of ")[1].split(", ")]
    return forms, BUS + (STATION if reader.test and key in ("step", "expect", "case") else "")


TITLES = {"plant": "A plant of ipos run", "test": "A test of ipos test", "campaign": "A campaign of ipos campaign"}


def root_schema(ipos, folder, kind):
    reader = Reader(ipos, folder, kind)
    keys = known(message for _, message in reader.errors(f"{PROBE} = 1\n"))
    properties = {}
    for key in keys:
        before = f'plant = "{CAMPAIGN_PLANT}"\n' if kind == "campaign" and key not in ("plant", "tests") else ""
        said = [message for _, message in reader.errors(f"{before}{key} = [7]\n")]
        if any("one for each" in message or f"[[{key}]]" in message for message in said):
            forms, before = forms_of(reader, key)
            items = {"type": "object"} if key == "case" else Table(reader, key, forms, before).schema()
            properties[key] = {"type": "array", "items": items}
        else:
            table = Table(reader, "", [""], before)
            table.head = lambda: ""
            properties[key] = table.value("", key)
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": TITLES[kind],
        "type": "object",
        "additionalProperties": False,
        "properties": properties,
    }


def share(plant, test):
    """Moves the tables of a plant to its $defs, and lets a test refer to those that it has in the same form."""
    plant["$defs"] = {}
    for key, table in plant["properties"].items():
        if "items" not in table:
            continue
        plant["$defs"][key] = table["items"]
        if test["properties"].get(key) == table:
            test["properties"][key] = {"type": "array", "items": {"$ref": f"plant.schema.json#/$defs/{key}"}}
        plant["properties"][key] = {"type": "array", "items": {"$ref": f"#/$defs/{key}"}}


def text_of(value, indent=""):
    """JSON with a line for each value that fits into one, so that a change of a key is a line in a diff."""
    line = json.dumps(value)
    if len(indent) + len(line) <= 120 or not isinstance(value, dict):
        return line
    rows = [f"{indent} {json.dumps(key)}: {text_of(part, indent + ' ')}" for key, part in value.items()]
    return "{\n" + ",\n".join(rows) + "\n" + indent + "}"


def main():
    ipos, target, check = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]), "--check" in sys.argv
    different = 0
    with tempfile.TemporaryDirectory() as folder:
        schemas = {kind: root_schema(ipos, folder, kind) for kind in TITLES}
        share(schemas["plant"], schemas["test"])
        for name, schema in schemas.items():
            text = text_of(schema) + "\n"
            file = target / f"{name}.schema.json"
            if not check:
                file.write_text(text)
            elif not file.exists() or file.read_text() != text:
                print(f"{file} is not what the readers say; make it anew: {sys.argv[0]} {sys.argv[1]} {target}")
                different += 1
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
