"""A fingerprint of the package, so that an edit makes the workflow compute again and a report says its maker."""

import hashlib
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@cache
def package_digest(*plugins: Path) -> str:
    """Return a digest of source and data of the whole package, and of the folders of plugins."""
    digest = hashlib.sha256()
    for folder in (ROOT, *plugins):
        for path in sorted(folder.rglob("*")):
            # what Python and numba keep there of a run is no source
            if path.is_file() and path.parent.name != "__pycache__":
                digest.update(path.relative_to(folder).as_posix().encode())
                digest.update(b"\0")
                digest.update(path.read_bytes())
    return digest.hexdigest()[:16]
