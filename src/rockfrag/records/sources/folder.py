"""The files of a folder that may be records."""

import os
from pathlib import Path, PurePath

_NO_RECORDS = frozenset(
    (".xml", ".pdf", ".md", ".json", ".html", ".htm", ".png", ".jpg", ".svg", ".yaml", ".yml")
)
"""Endings of what lies beside records: descriptions of stations, papers, pictures, facts."""


def is_no_record(name: str) -> bool:
    """Tell whether a file of a folder or an archive is passed over, by its name."""
    path = PurePath(name)
    return (
        path.name.startswith((".", "_SearchResults", "README", "LICENSE", "LICENCE"))
        or path.suffix.lower() in _NO_RECORDS
    )


def files_of(folder: str | os.PathLike[str]) -> list[Path]:
    """Return the files below a folder that may be records, in order of name."""
    found = sorted(path for path in Path(folder).rglob("*") if not path.is_dir())
    inside = Path(folder)
    return [
        path
        for path in found
        if not is_no_record(path.name)
        and not any(part.startswith(".") for part in path.relative_to(inside).parts)
    ]
