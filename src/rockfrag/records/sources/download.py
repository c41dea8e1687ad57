"""Files that stand at an address of their own, fetched once and checked by their digest."""

import os
from pathlib import Path

from rockfrag.base.errors import InputError
from rockfrag.base.files import sha256_of, whole_file
from rockfrag.records.parsing.text_file import MAX_BYTES, copy_within

_SILENCE = 60.0  # seconds that a server may keep silent


def fetch_url(url: str, sha256: str, path: str | os.PathLike[str]) -> None:
    """Put what an address gives at ``path``, if its SHA-256 is the one wanted.

    A file that is there is left alone, without network; one with another digest is an error.

    Parameters
    ----------
    url
        Address of one file.
    sha256
        Digest that it must have, in hexadecimal digits.
    path
        Where the file appears, whole or not at all.
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
    # imported here: slow to import, and most records come from elsewhere
    import urllib.request

    problem = f"{url}: more than {MAX_BYTES // 2**20} MiB are no record."
    try:
        request = urllib.request.Request(url, headers={"User-Agent": "rockfrag"})
        with whole_file(file) as part:
            with urllib.request.urlopen(request, timeout=_SILENCE) as answer:
                copy_within(answer, part, MAX_BYTES, problem)
            found = sha256_of(part)
            if found != sha256:
                raise InputError(
                    f"{url}: what came has the SHA-256 {found}, not {sha256}; nothing was kept."
                )
    except InputError:
        raise
    except (OSError, ValueError) as error:
        reason = (
            getattr(error, "reason", None) or getattr(error, "strerror", None) or error
        )
        raise InputError(
            f"{url}: could not be fetched ({' '.join(str(reason).split())}); put the file at {file} by hand."
        ) from error
