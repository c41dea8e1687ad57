"""Headers of lines ``KEY : value``, where a value may go on in lines without a key."""

import re
from collections.abc import Iterable, Mapping

from rockfrag.records.parsing.text_file import TextFile

_LINE = re.compile(r"^\s*(?P<key>[^:]*?)\s*:\s*(?P<value>.*?)\s*$")
_NOTE = re.compile(r"\s*[(\[][^)\]]*[)\]]")


def header_keys(lines: Iterable[str]) -> dict[str, str]:
    """Return the values of a header by their keys.

    Keys are in lower case, without notes in brackets, with single blanks: ``SAMPLING INTERVAL
    (sec)`` becomes ``sampling interval``. The first of two equal keys counts; a line with a colon
    but no key goes on with the value above it.
    """
    facts: dict[str, str] = {}
    key = ""
    for line in lines:
        match = _LINE.match(line)
        if match is None:
            continue
        named = " ".join(_NOTE.sub("", match["key"]).lower().split())
        if named:
            key = "" if named in facts else named
            if key:
                facts[key] = match["value"]
        elif key and match["value"]:
            facts[key] = f"{facts[key]} {match['value']}"
    return facts


def first_match(pattern: re.Pattern[str], lines: Iterable[str]) -> re.Match[str] | None:
    """Return the match in the first line that has a pattern."""
    return next(filter(None, map(pattern.search, lines)), None)


def number_of(text: TextFile, facts: Mapping[str, str], key: str) -> float:
    """Return the number of a header's key, a positive one."""
    words = facts.get(key, "")
    match = re.match(r"\d+(?:\.\d*)?(?:[Ee][+-]?\d{1,3})?|\.\d+", words)
    value = float(match[0]) if match else 0.0
    if not 0 < value < 1e12:
        text.fail(
            f"the header gives no number for {key!r}" + (f" but {words[:40]!r}" if words else "")
        )
    return value
