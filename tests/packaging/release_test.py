"""What of a release can be told without making one: the version stands in every place, the bill of materials holds together,
archives of the same files are the same bytes.
usage: release_test.py SOURCE"""

import json
import os
import re
import sys
import tarfile
import tempfile
import unittest
import zipfile
from pathlib import Path

SOURCE = Path(sys.argv[1])
sys.path.insert(0, str(SOURCE / "packaging"))
import release  # noqa: E402
import sbom  # noqa: E402
from third_parties import contained, rows, write_notices  # noqa: E402

# Every place with the version of the project, and how it stands there.
PLACES = {
    "python/pyproject.toml": r'^version = "(.+)"', "web/package.json": r'"version": "(.+)"',
    "tools/vscode/package.json": r'"version": "(.+)"', "packaging/debian/changelog": r"^ipos \((.+)\)", "CHANGELOG.md": r"^## (\d.+)",
}


class Release(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_the_version_stands_in_every_place(self):
        version = release.version()
        self.assertRegex(version, r"^\d+\.\d+\.\d+$")
        for place, form in PLACES.items():
            found = re.search(form, (SOURCE / place).read_text(), re.MULTILINE)
            self.assertEqual(found and found[1], version, place)
        self.assertTrue((SOURCE / f"python/ipos-{version}.dist-info").is_dir())

    def test_the_bill_holds_together(self):
        one, other = self.folder / "ipos-1-linux-x86_64", self.folder / "ipos-1.vsix"
        one.write_bytes(b"abc")
        other.write_bytes(b"")
        bill = json.loads(json.dumps(sbom.bill("1.2.3", "c0ffee", 0, {one: ["linux"], other: ["extension"]})))
        known = {"SPDXRef-DOCUMENT", *(entry["SPDXID"] for entry in bill["packages"] + bill["files"])}
        self.assertEqual(len(known), 1 + len(bill["packages"]) + len(bill["files"]), "an identifier twice")
        for relation in bill["relationships"]:
            self.assertLessEqual({relation["spdxElementId"], relation["relatedSpdxElement"]}, known)
        for name in known:
            self.assertRegex(name, r"^SPDXRef-[A-Za-z0-9.-]+$")
        self.assertEqual(bill["creationInfo"]["created"], "1970-01-01T00:00:00Z")
        # FIPS 180-2, appendix B.1.
        self.assertEqual(bill["files"][0]["checksums"][1]["checksumValue"],
                         "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad")
        inside = {entry["name"] for entry in bill["packages"]}
        for row in rows():
            self.assertEqual(row["name"] in inside, bool({"linux", "extension"} & set(row["in"])), row["name"])

    def test_every_part_is_in_a_file(self):
        parts = {part for parts in release.PARTS.values() for part in parts}
        self.assertEqual(parts, {part for row in rows() for part in row["in"]})

    def test_notices_have_what_is_contained(self):
        write_notices(["extension"], self.folder / "notices")
        text = (self.folder / "notices").read_text()
        for row in rows():
            self.assertEqual(f"\n{row['name']} {row['version']}, " in text, row in contained(["extension"]), row["name"])

    def test_archives_do_not_know_when_they_were_made(self):
        for number, names in enumerate([["b.txt", "a.txt"], ["a.txt", "b.txt"]]):
            folder = self.folder / str(number)
            folder.mkdir()
            with zipfile.ZipFile(self.folder / f"{number}.zip", "w") as packed:
                for name in names:
                    (folder / name).write_text(name)
                    os.utime(folder / name, (number * 1000, number * 1000))
                    os.chmod(folder / name, [0o600, 0o664][number])
                    packed.writestr(zipfile.ZipInfo(name, (2000 + number, 1, 1, 0, 0, 0)), name)
            release.pack_again(self.folder / f"{number}.zip", self.folder / f"{number}.again")
            release.pack_folder(folder, "x", self.folder / f"{number}.tar.gz", 7)
        for end in ("again", "tar.gz"):
            self.assertEqual((self.folder / f"0.{end}").read_bytes(), (self.folder / f"1.{end}").read_bytes())
        with tarfile.open(self.folder / "0.tar.gz") as tar:
            self.assertEqual(tar.getnames(), ["x", "x/a.txt", "x/b.txt"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
