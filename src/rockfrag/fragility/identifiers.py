"""Names of configurations as other programs take them, still told apart."""

import hashlib
from collections import Counter
from collections.abc import Iterable

LONGEST = 75
"""Characters of an identifier that OpenQuake takes."""


def identifiers(names: Iterable[str], others: str = "") -> dict[str, str]:
    """Return an identifier for each name: ASCII letters, digits and ``others``; all else becomes ``_``.

    Where two would be equal, or one would be too long, a digest of the name follows.
    """
    plain = {
        name: "".join(c if c.isascii() and (c.isalnum() or c in others) else "_" for c in name)
        for name in dict.fromkeys(names)
    }
    count = Counter(plain.values())
    return {
        name: text if count[text] == 1 and len(text) <= LONGEST else _with_digest(text, name)
        for name, text in plain.items()
    }


def _with_digest(text: str, name: str) -> str:
    digest = hashlib.sha256(name.encode()).hexdigest()[:8]
    return f"{text[: LONGEST - 9]}_{digest}"
