"""What the name of a component says of its direction: ``090``, ``N10E``, ``EW``, ``HNZ``, ``UP``."""

import re

_NAMED = {"N": 0.0, "NS": 0.0, "NORTH": 0.0, "E": 90.0, "EW": 90.0, "EAST": 90.0}
_NAMED |= {"S": 180.0, "SOUTH": 180.0, "W": 270.0, "WEST": 270.0, "SN": 180.0, "WE": 90.0}
_SEED = re.compile(r"^[BCDEHFLS][HNLG](?P<axis>[NEZ])\d{0,2}$")
_VERTICAL = re.compile(r"^(?:V|Z|U|UD|DU|UP|DOWN|DN|DWN|VERT(?:ICAL)?|VRT|UPDO|UPDN)\d?$")


def plain_name(words: str) -> str:
    """Return a name in capitals without blanks, marks of punctuation and the sign of a direction."""
    return re.sub(r"[\s_.,;:+-]+", "", words).upper()


def azimuth_of(words: str) -> float | None:
    """Return the azimuth [degrees from north, clockwise, 0 to 360], or None where none is named."""
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
    if quadrant is None:
        return None
    turn = float(quadrant["angle"]) * (1 if quadrant["to"] == "E" else -1)
    return (turn if quadrant["from"] == "N" else 180 - turn) % 360


def is_vertical(words: str) -> bool:
    """Tell whether the name of a component is that of a vertical one."""
    plain = plain_name(words)
    seed = _SEED.match(plain)
    return bool(_VERTICAL.match(plain)) or (seed is not None and seed["axis"] == "Z")
