"""Reads and writes links with a plant in them, from the form that docs/guide/browser.md describes and without code of the page.
  plant_link.py FOLDER < LINK     compares the files of a link with those of a folder; exit 1 when they differ
What a link has beside them is told, a line each."""
import base64
import gzip
import json
import pathlib
import re
import sys

BEGIN = "#plant="


def bytes_of(text):
    """Base64 of addresses, without padding (RFC 4648, section 5)."""
    if not re.fullmatch(r"[A-Za-z0-9_-]+", text):
        raise ValueError("a sign that is none of base64 for addresses")
    return base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))


def base64_of(content):
    return base64.urlsafe_b64encode(content).decode().rstrip("=")


def one_folder(path):
    return path != "" and not path.startswith("/") and ".." not in path.split("/")


def read(link):
    """Name of the folder, path of what is opened in it, and the bytes of each file by its path."""
    packed = bytes_of(link.split(BEGIN, 1)[1])
    content = json.loads(gzip.decompress(packed).decode())
    if set(content) != {"name", "plant", "files"}:
        raise ValueError(f"keys {sorted(content)}")
    files = {}
    for path, text in content["files"].items():
        if isinstance(text, str):
            files[path] = text.encode()
        elif set(text) == {"base64"}:
            files[path] = bytes_of(text["base64"]) if text["base64"] else b""
        else:
            raise ValueError(f"{path}: keys {sorted(text)}")
    name, plant = content["name"], content["plant"]
    if "/" in name or not all(one_folder(path) for path in [name, plant, *files]):
        raise ValueError("a path that leads out of the folder")
    if plant not in files:
        raise ValueError(f"{plant} is to be opened and is not there")
    return name, plant, files


def write(name, plant, files):
    """The fragment. The same files give the same one."""
    texts = {}
    for path, content in sorted(files.items()):
        try:
            texts[path] = content.decode()
        except UnicodeDecodeError:
            texts[path] = {"base64": base64_of(content)}
    text = json.dumps({"name": name, "plant": plant, "files": texts}, ensure_ascii=False, separators=(",", ":"))
    return BEGIN + base64_of(gzip.compress(text.encode(), mtime=0))


def main():
    name, plant, files = read(sys.stdin.read().strip())
    print(f"name {name}, plant {plant}")
    folder = pathlib.Path(sys.argv[1])
    expected = {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}
    wrong = [path for path, content in expected.items() if files.get(path) != content]
    for path in wrong:
        print(f"{path}: {'differs' if path in files else 'is not there'}")
    for path in sorted(set(files) - set(expected)):
        print(f"besides {path}, {len(files[path])} bytes")
    print(f"{len(expected) - len(wrong)} of {len(expected)} files equal")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
