"""How names of files say which component of a record they hold: ``CLS000``, ``TAB-L1``, ``GDLCN55W``, ``_N``."""

import re
from collections.abc import Iterable

from rockfrag.records.parsing.directions import is_vertical

_DIRECTIONS = (
    r"E-?W|W-?E|N-?S|S-?N|U-?D|[BEH][NLGH][ENZ123]|UP|DWN|DOWN|DN|VERT?|VERTICAL|VRT|UPDO"
    r"|FN|FP|LN|TR|LONG|TRAN"
)
_PATTERNS = tuple(
    re.compile(pattern, re.I)
    for pattern in (
        # the number of a station of an array may stand before the azimuth: H-E10050
        r"^(?P<stem>.*[A-Z_.\- ]\d{0,2}?)(?P<name>[0-3]\d\d)(?P<rest>)$",
        r"^(?P<stem>.+?)[-_. ]?(?P<name>[NS]\d{1,2}[EW])(?P<rest>)$",
        rf"^(?P<stem>.+?)[-_. ]?(?P<name>{_DIRECTIONS})(?P<rest>\d?)$",
        r"^(?P<stem>.+)[-_. ](?P<name>HOR(?:IZ\w*)?[-_ ]?[12])(?P<rest>)$",
        r"^(?P<stem>.+)[-_. ](?P<name>[NEZUVHXYLT]|NORTH|EAST|SOUTH|WEST|RADIAL|TRANSV\w*|LONGIT\w*)(?P<rest>)$",
        r"^(?P<stem>.+\d)(?P<name>[ENZV])(?P<rest>)$",
        # Tabas of PEER: -L1, -T1, -V1
        r"^(?P<stem>.+)[-_. ](?P<name>[LTVH]\d)(?P<rest>)$",
    )
)
_NUMBERED = re.compile(r"^(?P<stem>.+)(?P<name>[123])$")
_NUMBER = re.compile(r"^(?P<stem>.*?)(?P<number>\d+)$")
_TAIL = re.compile(
    r"(?i)[-_. ](?P<tail>hor(?:iz\w*)?[-_ ]?\d|up|vert?(?:ical)?|v"
    r"|acc(?:el\w*)?|raw|cor(?:r\w*)?|filt\w*|proc\w*|scaled|new|copy"
    r"|g|gals?|m?g|[cm]?m_?s2|data?)$"
)
_COPY = re.compile(r"(?i)(?:\s*\(\d+\)|[-_ ]+copy)$")
_BEFORE = re.compile(
    r"(?i)^(?P<name>E-?W|N-?S|U-?D|[ENZV]|[BEH][NLGH][ENZ123]|UP|VERT)[-_. ](?P<stem>.+)$"
)
_UPRIGHT = re.compile(r"(?i)(?:up|v|vert?(?:ical)?)$")
# a word of its own, with the station before it and the day behind it: STA_HNE_20200101
_WITHIN = re.compile(
    r"(?i)(?<=[-_. ])(?P<name>E-?W|N-?S|U-?D|[BEH][NLGH][ENZ123]|UP|VERT)(?=[-_. ])"
)

NUMBERS = frozenset("123")
"""Components that a file's name calls by a number alone."""


def parts_of(name: str) -> tuple[str, str]:
    """Return the name of a file without what names its component, and that component, empty if nothing does.

    Behind the component there may stand what the record was made into: ``SYL090-hor1``, ``ABC_NS_filtered``.
    """
    name = _COPY.sub("", name)
    tail = _TAIL.search(name)
    if tail is not None:
        stem, component = _split(name[: tail.start()])
        upright = _UPRIGHT.match(tail["tail"])
        # TCU045-V is the vertical of a station, PULDWN-up says it twice
        if component and (upright is None or is_vertical(component)):
            once_more = upright or tail["tail"].lower().startswith("hor")
            return (stem if once_more else f"{stem} {tail['tail'].lower()}"), component
    stem, component = _split(name)
    if component:
        return stem, component
    within = _WITHIN.findall(name)
    if len(within) == 1:
        return _WITHIN.sub("", name), within[0]
    before = _BEFORE.match(name)
    if before:
        return before["stem"], before["name"]
    numbered = _NUMBERED.match(name)
    return (numbered["stem"], numbered["name"]) if numbered else (name, "")


def _split(name: str) -> tuple[str, str]:
    """A file's name without what names its component, and that."""
    found = next(filter(None, (pattern.match(name) for pattern in _PATTERNS)), None)
    if found is None:
        return name, ""
    return found["stem"].rstrip("-_. ") + found["rest"], found["name"]


def numbered_records(names: Iterable[str]) -> set[str]:
    """Return those of names that are told from others by a number that does not only say 1, 2 and 3.

    The records r0, r1 and r2, r01 and r02, or GM1 to GM20, are numbered; A1 and A2 may be two components of one.
    """
    numbers: dict[str, str] = {}
    last: dict[str, set[str]] = {}
    for name in names:
        match = _NUMBER.match(name)
        if match is None:
            continue
        numbers[name] = match["number"]
        last.setdefault(name[:-1], set()).add(name[-1])
        if len(match["number"]) > 1:
            last.setdefault(match["stem"], set()).add(match["number"])
    return {
        name
        for name, number in numbers.items()
        if not last[name[:-1]] <= NUMBERS or re.fullmatch(r"0\d", number)
    }
