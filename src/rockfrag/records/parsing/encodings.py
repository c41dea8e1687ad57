"""The encoding of a header that is not UTF-8: the one in which words of records are understood."""

import re

from rockfrag.records.parsing.vocabulary import folded, words_for

_ENCODINGS = (
    *("latin-1", "gb18030", "cp932", "big5", "euc-kr", "cp1251", "koi8-r"),
    *("cp1254", "cp1253", "cp1250"),
)
"""Western Europe, China, Japan, Taiwan, Korea, Cyrillic, Turkey, Greece, Central Europe; of equals the first."""

_CONCEPTS = (
    *("time", "acceleration", "velocity", "displacement", "vertical", "north", "east"),
    *("interval", "rate", "count", "unit", "index"),
)
_FOREIGN = re.compile(r"[^\x00-\x7f]")


def encoding_of(head: bytes) -> str:
    """Return the encoding of the first lines of a file.

    Parameters
    ----------
    head
        Whole lines that are not UTF-8.

    Returns
    -------
    str
        A name that Python knows; ``latin-1`` where no word is understood in any.
    """
    foreign = b"\n".join(line for line in head.split(b"\n") if not line.isascii())
    return max(_ENCODINGS, key=lambda name: _understood(foreign, name))


def _understood(head: bytes, encoding: str) -> int:
    """Return how many characters stand in words that are understood, -1 of bytes that are not so encoded."""
    try:
        words = head.decode(encoding)
    except UnicodeDecodeError:
        return -1
    # of Western letters the accents are dropped when words are compared
    accents = re.sub(r"[A-Za-z]", "", words)
    if not _FOREIGN.search(accents):
        return 0
    plain = folded(words)
    return sum(
        len(match[0])
        for concept in _CONCEPTS
        for match in words_for(concept).finditer(plain)
    )
