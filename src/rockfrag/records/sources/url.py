"""Records from an address of the web, by their digest: fetched once, whole or not at all."""

import os
import urllib.error
import urllib.request
from pathlib import Path

from rockfrag.errors import InputError
from rockfrag.files import sha256_of, whole_file
from rockfrag.records.parsing.text_file import MAX_BYTES

_PATIENCE = 60.0  # seconds that a server may keep silent
_BLOCK = 2**20


def fetch_url(url: str, sha256: str, path: str | os.PathLike[str]) -> None:
    """Put what an address gives at ``path``, if its SHA-256 is the one wanted.

    A file that is there is left alone, without network; one with another digest is an error.
    """
    file = Path(path)
    if not url.startswith(("http://", "https://")):
        raise InputError(f"{url}: an address begins with http:// or https://.")
    if file.is_file():
        if sha256_of(file) != sha256:
            raise InputError(
                f"{file}: its SHA-256 is not the one given for {url}; remove the file to fetch it "
                "again, or correct the digest."
            )
        return
    try:
        with whole_file(file) as part:
            _download(url, part)
            found = sha256_of(part)
            if found != sha256:
                raise InputError(
                    f"{url}: what came has the SHA-256 {found}, not {sha256}; nothing was kept."
                )
    except (OSError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
        raise InputError(
            f"{url}: could not be fetched ({' '.join(str(reason).split())}); put the file at {file} by hand."
        ) from error


def _download(url: str, part: Path) -> None:
    request = urllib.request.Request(url, headers={"User-Agent": "rockfrag"})
    with urllib.request.urlopen(request, timeout=_PATIENCE) as answer, part.open("wb") as out:
        left = MAX_BYTES
        while block := answer.read(_BLOCK):
            left -= len(block)
            if left < 0:
                raise InputError(f"{url}: more than {MAX_BYTES // 2**20} MiB are no record.")
            out.write(block)
