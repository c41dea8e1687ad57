"""The files that may be records, of a folder or of an archive (zip and tar), unpacked within bounds."""

import os
import re
import tarfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path, PurePath, PurePosixPath
from tempfile import TemporaryDirectory
from typing import IO

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.text_files import printable
from rockfrag.records.parsing.text_file import MAX_BYTES, copy_within, read_head

MAX_MEMBERS = 5_000  # files of an archive; a download of a data centre has some hundred
MAX_TOTAL = 2 * MAX_BYTES  # bytes that an archive may unpack to
_TAR_NAMES = (".tar", ".tgz", ".tar.gz", ".tar.bz2", ".tbz2", ".tar.xz", ".txz")


@dataclass(frozen=True)
class Member:
    """A file of an archive: its name there, as far as it can be shown, and where it lies unpacked."""

    name: str
    path: Path


def is_archive(path: str | os.PathLike[str]) -> bool:
    """Tell whether a file is a zip or tar archive; Excel workbooks, zip files too, are as well."""
    return bool(_kind(path))


@contextmanager
def unpacked(path: str | os.PathLike[str]) -> Iterator[list[Member]]:
    """Give the files of an archive, in order of name, unpacked into a folder that is then removed."""
    with TemporaryDirectory(prefix="rockfrag.") as scratch:
        room = _Room(Path(scratch))
        members = room.take_out(path)
        nested = [member for member in members if is_archive(member.path)]
        for member in nested:
            with errors_of(f"{path}: member {member.name}"):
                members += room.take_out(member.path, f"{member.name}/")
        whole = [member for member in members if member not in nested]
        yield sorted(whole, key=lambda member: _by_number(member.name))


class _Room:
    """The folder that an archive is unpacked into, and how many bytes may still be put there."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.size, self.count = folder, MAX_TOTAL, 0

    def take_out(self, path: str | os.PathLike[str], prefix: str = "") -> list[Member]:
        """Write the members of an archive, whose names begin with a prefix."""
        members = _from_zip(path) if _kind(path) == "zip" else _from_tar(path)
        try:
            return [
                Member(prefix + printable(n), self._put(n, file, path))
                for n, file in members
            ]
        except InputError:
            raise
        # zipfile, tarfile and what unpacks for them raise many kinds
        except Exception as error:
            words = " ".join(str(error).split()) or type(error).__name__
            raise InputError(
                f"{path}: the archive cannot be unpacked ({words})."
            ) from None

    def _put(self, name: str, file: IO[bytes], archive: str | os.PathLike[str]) -> Path:
        """Write one member, in a folder like that of the archive, whatever its name says."""
        parts = [
            part
            for part in PurePosixPath(name.replace("\\", "/")).parts
            if part not in ("/", "..")
        ]
        safe = [re.sub(r"[^\w.+@=, ()\[\]-]", "_", part)[-100:] for part in parts] or [
            "unnamed"
        ]
        self.count += 1
        if self.count > MAX_MEMBERS:
            raise InputError(f"{archive}: it has more than {MAX_MEMBERS} members.")
        # the number keeps members apart whose names differ only in what is replaced
        target = self.folder.joinpath(*safe)
        if target.exists():
            target = self.folder / str(self.count) / safe[-1]
        target.parent.mkdir(parents=True, exist_ok=True)
        problem = f"{archive}: it unpacks to more than {MAX_TOTAL // 2**20} MiB."
        self.size -= copy_within(file, target, self.size, problem)
        return target


def _kind(path: str | os.PathLike[str]) -> str:
    """Kind of an archive by its first bytes, empty if it is none."""
    head = read_head(str(path), 512)
    if head.startswith((b"PK\x03\x04", b"PK\x05\x06")):
        return "zip"
    is_tar = head[257:262] == b"ustar"
    if not is_tar and str(path).lower().endswith(_TAR_NAMES):
        with suppress(Exception):
            is_tar = os.path.getsize(path) <= MAX_BYTES and tarfile.is_tarfile(path)
    return "tar" if is_tar else ""


def _from_zip(path: str | os.PathLike[str]) -> Iterator[tuple[str, IO[bytes]]]:
    """Yield names and open files of a zip archive."""
    with zipfile.ZipFile(path) as archive:
        if "[Content_Types].xml" in archive.namelist():
            raise InputError(
                f"{path}: this is an Excel workbook or a document; save it as CSV."
            )
        for info in archive.infolist():
            if info.is_dir() or is_hidden(info.filename):
                continue
            if info.flag_bits & 1:
                raise InputError(
                    f"{path}: the archive is locked by a password; unpack it first."
                )
            with archive.open(info) as file:
                yield info.filename, file


def _from_tar(path: str | os.PathLike[str]) -> Iterator[tuple[str, IO[bytes]]]:
    """Yield names and open files of a tar archive."""
    with tarfile.open(path) as archive:
        for info in archive:
            # links and devices are nothing that a record can be
            file = (
                archive.extractfile(info)
                if info.isfile() and not is_hidden(info.name)
                else None
            )
            if file is not None:
                yield info.name, file


def is_hidden(name: str) -> bool:
    """Tell whether a file of a folder or an archive is hidden, or lies in what is."""
    parts = [part for part in PurePosixPath(name).parts if part not in (".", "..")]
    return any(part.startswith(".") or part == "__MACOSX" for part in parts)


def _by_number(name: str) -> list[tuple[int, str]]:
    """Return what sorts RSN9 before RSN10."""
    return [
        (int(part), "") if part.isdecimal() and len(part) < 19 else (-1, part)
        for part in re.split(r"(\d+)", name)
    ]


_NO_RECORDS = frozenset(
    (
        ".xml",
        ".pdf",
        ".md",
        ".json",
        ".html",
        ".htm",
        ".png",
        ".jpg",
        ".svg",
        ".yaml",
        ".yml",
    )
)
"""Endings of what lies beside records: descriptions of stations, papers, pictures, facts."""


def is_no_record(name: str) -> bool:
    """Tell whether a file of a folder or an archive is passed over, by its name."""
    path = PurePath(name)
    return (
        path.name.startswith((".", "_SearchResults", "README", "LICENSE", "LICENCE"))
        or path.suffix.lower() in _NO_RECORDS
    )
