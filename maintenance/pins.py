"""Write down what an installation is made of: digests of all wheels, and the licences of all packages.

    .venv/bin/python maintenance/pins.py

Asks the package index which files pip would install here for the versions in ``requirements/constraints.txt``, and
writes ``requirements/<platform>.txt``, which pip checks with ``--require-hashes``, and ``docs/licences.md``.
"""

import json
import platform
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
EXTRAS = "workflow,test,lint"
BUILDING = ("setuptools", "wheel")
"""What builds the package itself, without looking for newer versions of it."""


def main() -> int:
    """Write both files; return 0."""
    packages = sorted(_packages(), key=lambda item: item["metadata"]["name"].lower())
    hashes = ROOT / "requirements" / f"{platform_name()}.txt"
    hashes.parent.mkdir(exist_ok=True)
    hashes.write_text("".join(_pins(packages)), encoding="utf-8")
    (ROOT / "docs" / "licences.md").write_text(
        "".join(_licences(packages)), encoding="utf-8"
    )
    print(
        f"{len(packages)} packages in {hashes.relative_to(ROOT)} and docs/licences.md"
    )
    return 0


def platform_name() -> str:
    """Name of the system that digests of wheels hold for, such as ``linux-x86_64-py311``."""
    version = f"py{sys.version_info.major}{sys.version_info.minor}"
    return f"{sys.platform}-{platform.machine()}-{version}"


def _packages() -> list[dict[str, Any]]:
    with tempfile.TemporaryDirectory() as scratch:
        report = Path(scratch) / "report.json"
        command = [
            *(
                sys.executable,
                "-m",
                "pip",
                "install",
                "--dry-run",
                "--ignore-installed",
                "--quiet",
            ),
            *(
                "--report",
                str(report),
                "--constraint",
                str(ROOT / "requirements/constraints.txt"),
            ),
            *(*BUILDING, f"{ROOT}[{EXTRAS}]"),
        ]
        subprocess.run(command, check=True)
        found: list[dict[str, Any]] = json.loads(report.read_text())["install"]
    return [item for item in found if "archive_info" in item["download_info"]]


def _pins(packages: Sequence[dict[str, Any]]) -> Iterator[str]:
    yield f"# Wheels of {platform_name()} that were tested together; made by maintenance/pins.py.\n"
    for package in packages:
        about = package["metadata"]
        digest = package["download_info"]["archive_info"]["hashes"]["sha256"]
        yield f"{about['name']}=={about['version']} --hash=sha256:{digest}\n"


def _licences(packages: Sequence[dict[str, Any]]) -> Iterator[str]:
    yield (
        "# Licences of what is installed\n\n"
        "As the packages state them (`maintenance/pins.py` writes this page). rockfrag itself is under the MIT "
        "licence\nand copies no code of theirs; tools of development are among them.\n\n"
        "| package | version | licence |\n|---|---|---|\n"
    )
    for package in packages:
        about = package["metadata"]
        name = about["name"]
        yield f"| {name} | {about['version']} | {licence_of(name)} |\n"


def licence_of(package: str) -> str:
    """Licence of an installed package in a few words: the expression, the classifiers, or its first line."""
    try:
        about = metadata(package)
    except PackageNotFoundError:
        return "MIT" if package in BUILDING else "not installed here"
    classes = [
        item.rpartition(" :: ")[2]
        for item in about.get_all("Classifier", [])
        if item.startswith("License :: ")
    ]
    text = str(about.get("License") or "").strip().splitlines()
    said = (
        about.get("License-Expression")
        or ", ".join(classes)
        or (text[0] if text else "")
    )
    return str(said)[:80].replace("|", "/") or "not stated"


if __name__ == "__main__":
    sys.exit(main())
