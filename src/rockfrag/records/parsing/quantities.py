"""Units that accelerations are stored in, and the words that formats use for them and for directions."""

import re

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY

TO_SI = {"g": GRAVITY, "g/10": GRAVITY / 10, "%g": GRAVITY / 100, "mg": GRAVITY / 1e3}
TO_SI |= {
    "ug": GRAVITY / 1e6,
    "m/s2": 1.0,
    "cm/s2": 0.01,
    "mm/s2": 0.001,
    "in/s2": 0.0254,
}
"""Factor from each unit of acceleration to m/s²."""

ASKED_UNITS = ("g", "m/s2", "cm/s2", "gal", "mm/s2")  # that a user may name
_SYNONYMS = {"gal": "cm/s2", "gals": "cm/s2", "inch/s2": "in/s2", "inches/s2": "in/s2"}
_SYNONYMS |= {"g's": "g", "gs": "g", "microg": "ug", "milli-g": "mg", "micro-g": "ug"}
_SYNONYMS |= {"%ofg": "%g", "percentg": "%g", "count": "counts"}
_OTHER_UNITS = {
    "velocity": "m/s cm/s mm/s in/s km/h",
    "displacement": "m cm mm in km inch inches ft um µm",
    "force": "kn mn lbf kip kips kgf tf",
    "pressure": "pa kpa mpa gpa bar psi ksi kn/m2 n/mm2",
    "temperature": "°c degc celsius °f degf kelvin",
    "voltage": "mv uv µv volt volts",
    "current": "ma amp",
    "resistance": "ohm ohms kohm mohm ω kω",
    "frequency": "hz khz",
    "angle": "deg ° rad mrad rad/s deg/s °/s rad/s2",
    "strain": "µε microstrain mm/m",
    "mass": "kg",
    "moment": "knm kn.m kn-m nm n.m",
    "energy": "kj kwh",
    "level": "db dba",
    "raw counts": "counts",
}
_OTHER_QUANTITIES = {
    unit: name for name, units in _OTHER_UNITS.items() for unit in units.split()
}
"""Units that no acceleration has; single letters are left out, which may name a direction."""


def canonical_unit(words: str) -> str:
    """Return the one spelling used here for a unit, or the words themselves if it is unknown.

    ``CM/SEC/SEC``, ``cm/s^2``, ``cm/sec2``, ``cm s-2`` and ``gal`` all give ``cm/s2``.
    """
    unit = re.sub(r"\s+", "", words.strip().strip("().,;").lower())
    unit = re.sub(r"seconds?|secs?", "s", unit)
    unit = (
        unit.replace("**", "").replace("^", "").replace("²", "2").replace("cm.", "cm")
    )
    unit = re.sub(r"/s/s$|/\(s2\)$|/ss$|\.?s-2$|/s\*s$", "/s2", unit)
    unit = re.sub(r"\.?s-1$", "/s", unit)
    return _SYNONYMS.get(unit, unit)


def quantity_of(unit: str) -> str:
    """Return ``acceleration``, ``velocity``, ``force``, … for a canonical unit, or ``""`` for an unknown one."""
    if unit in TO_SI:
        return "acceleration"
    return _OTHER_QUANTITIES.get(unit, "")


def asked_unit(unit: str) -> str:
    """Check a unit that the user named and return its canonical spelling."""
    found = canonical_unit(unit)
    if found not in {canonical_unit(known) for known in ASKED_UNITS}:
        raise InputError(
            f"unit {unit!r} is not a unit of acceleration known here; give one of {', '.join(ASKED_UNITS)}."
        )
    return found


_NAMED = {"N": 0.0, "NS": 0.0, "NORTH": 0.0, "E": 90.0, "EW": 90.0, "EAST": 90.0}
_NAMED |= {
    "S": 180.0,
    "SOUTH": 180.0,
    "W": 270.0,
    "WEST": 270.0,
    "SN": 180.0,
    "WE": 90.0,
}
_SEED = re.compile(r"^[BCDEHFLS][HNLG](?P<axis>[NEZ])\d{0,2}$")
_VERTICAL = re.compile(
    r"^(?:V|Z|U|UD|DU|UP|DOWN|DN|DWN|VERT(?:ICAL)?|VRT|UPDO|UPDN)\d?$"
)


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
