"""Directions of components: azimuths, verticals and other names, in the words of several languages."""

import re

from rockfrag.records.parsing.vocabulary import folded, spaced, words_for

_NAMED = {"N": 0.0, "NS": 0.0, "E": 90.0, "EW": 90.0, "WE": 90.0, "EO": 90.0}
_NAMED |= {"S": 180.0, "SN": 180.0, "W": 270.0}
_WORDS = {"north": 0.0, "east": 90.0, "south": 180.0, "west": 270.0}
# the third of 1, 2, 3 is the vertical by the rules of the FDSN, whatever the others are turned by
_SEED = re.compile(r"^(?!CH\d)[A-Z][HNLG](?P<axis>[NEZ123])\d{0,2}$")
_VERTICAL = re.compile(r"^(?:V|Z|U|D|UD|DU|A_?Z|G_?F?Z|[+-][VZU]|[VZU][+-])\d?$", re.I)
_AXIS = re.compile(
    r"(?i)^(?:[NSEWUD]-?[NSEWUD]|[NEZUVLTRXYH][+-]?\d?|[+-][NEZUVLTXY]|[ag]F?_?[xyz]|H[12]|FN|FP"
    r"|[xyz][ _-]?axis|axis[ _-]?[xyz]"
    r"|[A-Z][NLGH][ENZ123]\d{0,2}|[NS]\d{1,2}(?:\.\d+)?[EW]|\d{1,3}|ch(?:annel)?\W?\d+"
    r"|(?:canal|kanal|канал|通道|チャンネル)\W*\d+)$"
)
_DIRECTIONS = ("vertical", "north", "east", "south", "west", "horizontal")
_NUMBERED = re.compile(r"\d+$")


def plain_name(words: str) -> str:
    """Return a name in capitals without blanks, marks of punctuation and the sign of a direction."""
    return re.sub(r"[\s_.,;:+-]+", "", words).upper()


def azimuth_of(words: str) -> float | None:
    """Return the azimuth [degrees from north, clockwise, 0 to 360], or None where none is named.

    Parameters
    ----------
    words
        Name of a component: ``090``, ``N35W``, ``EW``, ``HNE``, ``Norte``.

    Returns
    -------
    float or None
        Degrees clockwise from north, 0 to 360.
    """
    plain = plain_name(words).removesuffix("DEGREES").removesuffix("DEG")
    if re.fullmatch(r"\d{1,3}", plain):
        return float(plain) % 360
    if re.fullmatch(r"\d{1,3}\.\d+", words.strip()):
        return float(words) % 360
    if plain in _NAMED:
        return _NAMED[plain]
    seed = _SEED.match(plain)
    if seed is not None:
        return {"N": 0.0, "E": 90.0}.get(seed["axis"])
    quadrant = re.fullmatch(r"(?P<from>[NS])(?P<angle>\d{1,2})(?P<to>[EW])", plain)
    if quadrant is not None:
        turn = float(quadrant["angle"]) * (1 if quadrant["to"] == "E" else -1)
        return (turn if quadrant["from"] == "N" else 180 - turn) % 360
    named = [
        azimuth
        for concept, azimuth in _WORDS.items()
        if words_for(concept).fullmatch(folded(words).strip())
    ]
    return named[0] if named else None


def is_vertical(words: str) -> bool:
    """Tell whether the name of a component is that of a vertical one.

    Parameters
    ----------
    words
        Name of a component: ``UP``, ``HNZ``, ``comp. V``, ``垂直``.

    Returns
    -------
    bool
        False of names that say nothing.
    """
    plain = spaced(words).strip()
    seed = _SEED.match(plain_name(plain))
    if seed is not None:
        return seed["axis"] in "Z3"
    if _VERTICAL.match(re.sub(r"[\s.-]", "", plain)):
        return True
    parts = re.split(r"[\s_()\[\].,;:/-]+", folded(plain).strip(" _()[].,;:/-"))
    vertical = words_for("vertical")
    # a single letter counts at an end: Acc Z, comp. V
    ends = (part for part in (parts[0], parts[-1]) if len(part) < 3)
    return bool(vertical.search(folded(plain))) or any(map(_VERTICAL.match, ends))


def is_seismometer(code: str) -> bool:
    """Tell whether a SEED code such as ``EHZ`` is that of a seismometer or geophone, which records velocity."""
    return re.fullmatch(r"(?i)[A-Z][HP][A-Z0-9]", code.strip()) is not None


def is_direction(words: str) -> bool:
    """Tell whether words name the direction of a component, and nothing else."""
    plain = folded(words).strip(" _.,;:()[]")
    if _AXIS.match(plain):
        return True
    bare = _NUMBERED.sub("", plain)
    return bool(bare) and any(words_for(each).fullmatch(bare) for each in _DIRECTIONS)


def names_direction(words: str) -> bool:
    """Tell whether words have one for a direction in them: ``Canal 2 (NS)``, ``comp. vertical``."""
    plain = folded(words)
    if any(words_for(each).search(plain) for each in _DIRECTIONS):
        return True
    parts = re.split(r"[\s_()\[\].,;:]+", plain)
    return any(
        len(part) > 1 and _AXIS.match(part) and not part.isdigit() for part in parts
    )
