"""A fingerprint of the package's source, so that an edit makes the workflow compute again."""

import hashlib
from pathlib import Path

STAGES = (
    "records",
    "motions",
    "building",
    "rocking",
    "shaketable",
    "fragility",
    "pedestal",
    "thesis",
    "study",
    "stages",
    "report",
)
"""The package's folders in the order in which data flow; each imports from those before it only."""


def source_digest(last: str) -> str:
    """Return a digest of every source file that a result of the stage ``last`` can depend on.

    These are the modules at the package's top level, the reading of studies, and the folders up to
    and including ``last``. An edit in the report thus leaves the response histories alone.
    """
    root = Path(__file__).resolve().parents[1]
    folders = [*STAGES[: STAGES.index(last) + 1], "study", "stages"]
    files = [path for path in root.iterdir() if path.is_file() and path.name != "cli.py"]
    for folder in folders:
        files += [
            path
            for path in (root / folder).rglob("*")
            if path.is_file() and "__pycache__" not in path.parts
        ]
    digest = hashlib.sha256()
    for path in sorted(set(files)):
        digest.update(path.relative_to(root).as_posix().encode())
        digest.update(b"\0")
        digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
