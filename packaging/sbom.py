"""The bill of materials of a release, SPDX 2.3 as JSON: the project, its files with checksums, the third parties in each."""

import hashlib
import re
from datetime import datetime, timezone
from pathlib import Path

from third_parties import contained


def identifier(kind: str, name: str) -> str:
    return f"SPDXRef-{kind}-" + re.sub(r"[^A-Za-z0-9.-]+", "-", name).strip("-")


def digest(kind: str, file: Path) -> dict:
    return {"algorithm": kind.upper(), "checksumValue": hashlib.new(kind, file.read_bytes()).hexdigest()}


def bill(version: str, commit: str, seconds: int, files: dict[Path, list[str]]) -> dict:
    """`files` are those of the release with their parts (third_parties.contained)."""
    packages = {"SPDXRef-Package-ipos": {
        "SPDXID": "SPDXRef-Package-ipos", "name": "ipos", "versionInfo": version, "downloadLocation": "NOASSERTION",
        "licenseConcluded": "MIT", "licenseDeclared": "MIT", "copyrightText": "Copyright (c) 2026 the ipos contributors",
        "filesAnalyzed": False, "primaryPackagePurpose": "APPLICATION"}}
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", "SPDXRef-Package-ipos")]
    listed = []
    for file, parts in sorted(files.items()):
        of_file = identifier("File", file.name)
        listed.append({"SPDXID": of_file, "fileName": f"./{file.name}", "checksums": [digest("sha1", file), digest("sha256", file)],
                       "licenseConcluded": "NOASSERTION", "licenseInfoInFiles": ["NOASSERTION"], "copyrightText": "NOASSERTION"})
        relations.append((of_file, "GENERATED_FROM", "SPDXRef-Package-ipos"))
        for row in contained(parts):
            of_row = identifier("Package", row["name"])
            packages[of_row] = {
                "SPDXID": of_row, "name": row["name"], "versionInfo": row["version"], "downloadLocation": "NOASSERTION",
                "homepage": row["home"], "licenseConcluded": row["licence"], "licenseDeclared": row["licence"],
                "copyrightText": "NOASSERTION", "filesAnalyzed": False, "externalRefs": references(row)}
            relations.append((of_file, "CONTAINS", of_row))
    return {
        "spdxVersion": "SPDX-2.3", "dataLicense": "CC0-1.0", "SPDXID": "SPDXRef-DOCUMENT", "name": f"ipos-{version}",
        "documentNamespace": f"https://spdx.org/spdxdocs/ipos-{version}-{commit}",
        "creationInfo": {"created": datetime.fromtimestamp(seconds, timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
                         "creators": ["Organization: the ipos contributors", "Tool: packaging/sbom.py"]},
        "packages": [packages[name] for name in sorted(packages)], "files": listed,
        "relationships": [{"spdxElementId": one, "relationshipType": kind, "relatedSpdxElement": other}
                          for one, kind, other in relations]}


def references(row: dict) -> list[dict]:
    """Where else it is known by: packages as package URLs write them. Those of Debian have Debian's own version, which is not ours."""
    urls = []
    for package in row["found"]:
        kind, name = package.split(":", 1)
        urls.append(f"pkg:npm/{name.replace('@', '%40')}@{row['version']}" if kind == "npm" else f"pkg:deb/debian/{name}")
    return [{"referenceCategory": "PACKAGE-MANAGER", "referenceType": "purl", "referenceLocator": url} for url in urls]
