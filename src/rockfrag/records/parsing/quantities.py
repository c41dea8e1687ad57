r"""Units by one grammar: a factor, a prefix, and products of length and time, in the writings of files.

``cm/s²``, ``CM/SEC/SEC``, ``cm s-2``, ``m·s⁻²``, ``acc_m_s2``, ``cms2``, ``м/с²``, ``10-3 g``, ``milli_g`` and
``µGal`` are understood. A factor that may be meant either way (``g x1000``) is none that can be applied, and
a unit that is not known is told from one that is not stated.
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import lru_cache

from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY
from rockfrag.records.parsing.vocabulary import folded, words_for

TO_SI: Mapping[str, float] = {
    **{"g": GRAVITY, "g/10": GRAVITY / 10, "%g": GRAVITY / 100},
    **{"mg": GRAVITY / 1e3, "ug": GRAVITY / 1e6},
    **{"m/s2": 1.0, "dm/s2": 0.1, "cm/s2": 0.01, "mm/s2": 0.001, "km/s2": 1e3},
    **{"um/s2": 1e-6, "nm/s2": 1e-9, "mgal": 1e-5, "ugal": 1e-8},
    **{"in/s2": 0.0254, "ft/s2": 0.3048},
}
"""Factor from each unit of acceleration that has a name of its own to m/s²."""

ASKED_UNITS = ("g", "m/s2", "cm/s2", "gal", "mm/s2")  # that a message proposes

_PREFIXES = {"": 1.0, "k": 1e3, "d": 0.1, "c": 0.01, "m": 1e-3, "u": 1e-6, "n": 1e-9}
_PREFIX_WORDS = {"milli": "m", "micro": "u", "mikro": "u", "nano": "n", "centi": "c"}
_PREFIX_WORDS |= {
    "kilo": "k",
    "deci": "d",
    "μ": "u",
    "мк": "u",
    "м": "m",
    "с": "c",
    "к": "k",
}
_METRE = r"m|met(?:er|re)s?|metros?|metri|metr[oy]?|м|метр\w*|米|メートル|미터"
_LENGTHS = {"in": 0.0254, "inch": 0.0254, "inches": 0.0254, "ins": 0.0254}
_LENGTHS |= {"ft": 0.3048, "feet": 0.3048, "foot": 0.3048, "pie": 0.3048}
_LENGTHS |= {"pies": 0.3048, "cms": 0.01, "mms": 0.001}
_LENGTHS |= {"zoll": 0.0254, "pouce": 0.0254, "pouces": 0.0254}
_LENGTHS |= {"pulgada": 0.0254, "pulgadas": 0.0254, "pollici": 0.0254}
_LENGTHS |= {"厘米": 0.01, "毫米": 0.001, "公分": 0.01}
_SECOND = (
    r"s|secs?|seconds?|seg|segs|segundos?|sek|sekunden?|secondes?|secondi|sn|saniye"
    r"|с|сек|секунд\w*|秒|초"
)
_TIMES = {"min": 60.0, "mins": 60.0, "minute": 60.0, "minutes": 60.0, "мин": 60.0}
_TIMES |= {"h": 3600.0, "hr": 3600.0, "hrs": 3600.0, "hour": 3600.0, "hours": 3600.0}
_GAL = r"gals?|galileo|гал|カル|ガル|伽|갈"
_GRAVITY_UNIT = r"g|gs|g's|gn|g0|gees?|gravity|gforce"

_OTHER_UNITS = {
    "velocity": "kine kines knots mph mps カイン",
    "displacement": "mil mils",
    "force": "kn mn lbf kip kips kgf tf newton newtons",
    "pressure": "pa kpa mpa gpa bar psi ksi kn/m2 n/mm2 hpa mbar",
    "temperature": "°c degc celsius °f degf kelvin",
    "voltage": "mv uv μv volt volts kv",
    "current": "ma amp amps ampere",
    "resistance": "ohm ohms kohm mohm ω kω",
    "frequency": "hz khz mhz гц кгц",
    "angle": "deg ° rad mrad rad/s deg/s °/s rad/s2 deg/s2 dps",
    "strain": "με ue microstrain mm/m m/m",
    "mass": "kg lb lbs",
    "moment": "knm kn.m kn-m kn·m nm n.m n·m",
    "energy": "kj kwh",
    "level": "db dba",
    "raw counts": "counts count cnt cnts lsb digit digits bits adc",
    "magnetic field": "ut μt nt tesla gauss",
    "a number without a unit": "normalized normalised normiert normalizado au a.u arb arb.units",
}
_OTHER_QUANTITIES = {
    unit: name for name, units in _OTHER_UNITS.items() for unit in units.split()
}
"""Units that no acceleration has; single letters are left out, which may name a direction."""

_DIMENSIONS = {
    (1, 2): "acceleration",
    (1, 1): "velocity",
    (1, 0): "displacement",
    (0, 1): "time",
}
_REAL = r"\d+(?:[.,]\d*)?(?:e[+-]?\d+)?|[.,]\d+(?:e[+-]?\d+)?"
_TEN = r"10\s*(?:\^|\*\*)?\s*[({]?\s*(?P<power>[+-]\d{1,2})\s*[)}]?"
_POWER = r"10\s*(?:\^|\*\*)\s*[({]?\s*\+?(?P<positive>\d{1,2})\s*[)}]?"
_NUMBER = rf"(?:{_TEN}|{_POWER}|1\s*/\s*(?P<part>\d+)|(?P<plain>{_REAL}))"
_TEN_TIMES_TOO_MUCH = re.compile(r"10\.?0*e")
_FACTOR_BEFORE = re.compile(
    rf"^(?P<sign>[x×*]?)\s*{_NUMBER}(?![\w.])\s*[x×*·]?\s*(?P<unit>[^\d\s].*)$"
)
_FACTOR_BEHIND = re.compile(
    rf"^(?P<unit>.*?[^\d\s].*?)\s*(?:[x×*·]|\btimes\b|\bby\b|\s)\s*{_NUMBER}$"
)
_TOKEN = re.compile(
    r"\s*(?P<over>/|\bper\b|\bpor\b|\bje\b|\bpro\b)?[\s._·*(-]*"
    r"(?P<word>[^\W\d_]+|%|°[cf]?)(?:[\s_]*(?:\^|\*\*)?\s*\(?\s*(?P<power>[+-]?\d)\)?)?[)]?"
)


@dataclass(frozen=True)
class Unit:
    """What words in the place of a unit are."""

    name: str  # the one spelling used here; the words themselves if they are no unit known here
    # ``acceleration``, ``velocity``, ``force``, ``time``, …; empty if the unit is not known
    quantity: str = ""
    to_si: float = math.nan  # factor to m/s² of an acceleration, to s of a time
    # a factor beside the unit that may be meant either way, in the words of the file
    factor: str = ""


@lru_cache(maxsize=4096)
def read_unit(words: str) -> Unit:
    """Return the unit that words are.

    Parameters
    ----------
    words
        As they stand in brackets behind a title or behind ``units:``.

    Returns
    -------
    Unit
        With an empty quantity if the words are no unit known here.
    """
    plain = _plain(words)
    if part_of_g := _part_of_g(plain):
        return _named(part_of_g)
    before = _FACTOR_BEFORE.match(plain)
    if before and _TEN_TIMES_TOO_MUCH.match(before["plain"] or ""):
        # as many who write 10E-3 mean 10⁻³ as mean 0.01
        return Unit(plain, "acceleration", factor=plain)
    if before and (found := _without_factor(before["unit"])):
        value = _value(before)
        if found.quantity == "acceleration" and 0 < value < 1:
            # as in 10⁻³ g: the unit is a part of another one
            return _named(value * found.to_si)
        return found if value == 1 else Unit(plain, found.quantity, factor=plain)
    if found := _bare_unit(plain) or _said_twice(plain) or _with_remark(plain):
        return found
    behind = _FACTOR_BEHIND.match(plain)
    if behind and (found := _without_factor(behind["unit"])):
        return (
            found if _value(behind) == 1 else Unit(plain, found.quantity, factor=plain)
        )
    return Unit(plain)


def _without_factor(plain: str) -> Unit | None:
    """Return the unit beside a factor, or None."""
    part_of_g = _part_of_g(plain)
    return _named(part_of_g) if part_of_g else _bare_unit(plain)


def _plain(words: str) -> str:
    """Return words in the place of a unit without brackets, quotation marks and the signs of LaTeX."""
    plain = folded(words)
    plain = re.sub(r"^(0?[.,]\d+)(?=[^\W\d_e])", r"\1 ", plain)
    plain = re.sub(r"\\(?:mathrm|text|rm|,|;|cdot|frac)?|\$|[{}]", " ", plain)
    plain = re.sub(r"\s+", " ", plain).strip(" \t\"'.,;:[]")
    while plain.startswith("(") and plain.endswith(")") and plain.count("(") == 1:
        plain = plain[1:-1].strip(" \t\"'.,;:[]")
    if plain.count("(") != plain.count(")"):
        plain = plain.strip("() ")
    return plain


def _said_twice(plain: str) -> Unit | None:
    """Return the unit of words such as ``gal (cm/s2)`` and ``g (9.81 m/s2)``, or None."""
    twice = re.fullmatch(r"(?P<first>[^()]+)\((?P<second>[^()]+)\)", plain)
    if twice is None:
        return None
    first, second = _bare_unit(twice["first"]), _bare_unit(twice["second"])
    of_g = re.fullmatch(r"9\.8\d*\s*(?:m/s2)?", twice["second"].strip())
    same = first == second or (first == _named(GRAVITY) and of_g)
    return first if same else None


def _with_remark(plain: str) -> Unit | None:
    """Return the unit before words without a number, as in ``g, filtered``, or None."""
    parts = re.fullmatch(r"(?P<unit>[^,;:(]+?)\s*[,;:(]\s*(?P<remark>[^\d%]+)", plain)
    if parts is None or words_for("factor").search(parts["remark"]):
        return None
    found = _bare_unit(parts["unit"])
    return None if _bare_unit(parts["remark"]) else found


def _part_of_g(plain: str) -> float:
    """Return what one unit of per cent of g, or of g/10, g/100 ... of networks, is in m/s²; 0 of others."""
    squeezed = plain.replace(" ", "")
    if re.fullmatch(
        rf"(?:%|percent|percentage|pct)(?:of)?(?:{_GRAVITY_UNIT})", squeezed
    ):
        return TO_SI["%g"]
    tenth = re.fullmatch(r"g/(10+)", squeezed)
    return GRAVITY / float(tenth[1]) if tenth else 0.0


def _value(match: re.Match[str]) -> float:
    """Return the number of a factor."""
    if match["power"] or match["positive"]:
        return 10.0 ** int(match["power"] or match["positive"])
    if match["part"]:
        return 1 / float(match["part"]) if float(match["part"]) else math.inf
    return float(match["plain"].replace(",", "."))


def _named(to_si: float) -> Unit:
    """Return the unit of acceleration of a factor to m/s², with the name that it has, if any."""
    known = next((name for name, own in TO_SI.items() if math.isclose(own, to_si)), "")
    if known:
        return Unit(known, "acceleration", TO_SI[known])
    return Unit(f"{to_si:.12g} m/s2", "acceleration", to_si)


_PREFIX_WORD_APART = re.compile(r"(milli|micro|mikro|nano|\bg)[\s_-]+(?!$)")


def _bare_unit(plain: str) -> Unit | None:
    """Return the unit that words without a factor are, or None."""
    plain = plain.strip(" .,;:()[]")
    squeezed = re.sub(r"\*\*|\^|\s", "", plain)
    if squeezed in _OTHER_QUANTITIES:
        name = "counts" if _OTHER_QUANTITIES[squeezed] == "raw counts" else squeezed
        return Unit(name, _OTHER_QUANTITIES[squeezed])
    # N_gal is a component in gal, and no nanogal
    joined = _PREFIX_WORD_APART.sub(r"\1", plain)
    of_gravity = _prefixed(joined, f"{_GAL}|{_GRAVITY_UNIT}")
    if of_gravity is not None:
        prefix, symbol = of_gravity
        to_si = 0.01 if re.fullmatch(_GAL, symbol) else GRAVITY
        if prefix in ("", "m", "u", "n"):
            return _named(_PREFIXES[prefix] * to_si)
    parts = _parts(plain)
    return _of_dimension(parts) if parts else None


def _prefixed(word: str, symbols: str) -> tuple[str, str] | None:
    """Return the prefix of SI and the symbol that a word is made of."""
    prefixes = "|".join([*_PREFIX_WORDS, "[kdcmun]"])
    match = re.fullmatch(rf"(?P<symbol>{symbols})", word)
    if match:
        return "", match["symbol"]
    match = re.fullmatch(rf"(?P<prefix>{prefixes})(?P<symbol>{symbols})", word)
    if not match:
        return None
    return _PREFIX_WORDS.get(match["prefix"], match["prefix"]), match["symbol"]


_SQUEEZED = re.compile(r"(?P<length>.+?)p?(?P<time>s|с)(?:2|s)")


def _parts(plain: str) -> list[tuple[str, int]]:
    """Return the symbols of a unit and their powers, none if the words are no product of symbols."""
    words = re.sub(r"(?<=\w)\s*-\s*(?=[^\W\d_])", " ", plain)
    words = re.sub(r"\b(?:squared?|sq|al cuadrado|carre|quadrato)\b\.?", "^2", words)
    words = re.sub(r"\^2\s+(?:second\w*|sec|s)\b", "s^2", words)
    found, position, sign = [], 0, 1
    while position < len(words):
        match = _TOKEN.match(words, position)
        if match is None or match.end() == position:
            return []
        sign = -1 if match["over"] else sign
        power = int(match["power"] or 1)
        found.append((match["word"], sign * abs(power) if sign < 0 else power))
        position = match.end()
    return found


def _of_dimension(parts: list[tuple[str, int]]) -> Unit | None:
    """Return the unit that a product of lengths and times is."""
    if len(parts) == 1:
        # ms2 is no square of milliseconds
        joined = _SQUEEZED.fullmatch(
            f"{parts[0][0]}{abs(parts[0][1])}".removesuffix("1")
        )
        if joined and _length(joined["length"]) is not None:
            parts = [(joined["length"], 1), (joined["time"], -2)]
    length, time, factor = 0, 0, 1.0
    for word, power in parts:
        word, power = ("s", 2 * power) if word in ("ss", "сс") else (word, power)
        metres, seconds = _length(word), _time(word)
        # a first m is a metre, one below the stroke a minute is never
        if metres is not None and (seconds is None or not length):
            length, factor = length + power, factor * metres**power
        elif seconds is not None and (length or len(parts) == 1):
            # m s2 and m_s2 have lost their stroke: nothing is measured in metres times seconds
            below = abs(power) if length else -abs(power)
            time, factor = time + below, factor / seconds**below
        else:
            return None
    quantity = _DIMENSIONS.get((length, abs(time)), "")
    if quantity == "acceleration":
        return _named(factor) if factor <= 1 or factor in TO_SI.values() else None
    if quantity == "time" and parts[0][1] == 1:
        return Unit(_spelled(parts), quantity, factor)
    known = quantity in ("velocity", "displacement")
    return Unit(_spelled(parts), quantity) if known else None


def _spelled(parts: list[tuple[str, int]]) -> str:
    """Join the words of a length and a time to a unit: m and s give m/s; a single word stays as it is."""
    return "/".join(word for word, _ in parts)


def _length(word: str) -> float | None:
    """Return the metres of a unit of length."""
    if word in _LENGTHS:
        return _LENGTHS[word]
    found = _prefixed(word, _METRE)
    return None if found is None else _PREFIXES[found[0]]


def _time(word: str) -> float | None:
    """Return the seconds of a unit of time."""
    if word in _TIMES:
        return _TIMES[word]
    found = _prefixed(word, _SECOND)
    return None if found is None else _PREFIXES[found[0]]


# words in brackets of fewer letters are taken for a unit
_LONGEST_UNIT = 3
_REMARKS = frozenset(
    {"raw", "abs", "rel", "top", "mid", "bot", "cor", "eq", "th", "lin"}
)
_SQUARE_SECONDS = re.compile(r"(?<![^\W\d_])[^\W\d_]{1,3}s2$")  # fps2
_PART_OF_LETTERS = re.compile(r"\W*\d*[.,]\d+\s*[^\W\d_]{1,3}")  # 0.001 V
_SIGNS_OF_UNITS = re.compile(r"[/^%*·²]|\bper\b")
_FACTOR = re.compile(
    r"(?:×|(?<!\*)\*(?!\*))\s*\d|\d\s*(?:×|\*(?!\*))|\bx\s*(?:10|\d*[.,]\d|\d+e)"
    r"|10\s*(?:\^|\*\*)|\b1?0?e[+-]?\d|\b10-\d"
)


def has_factor(words: str) -> bool:
    """Tell whether words have a factor in them that numbers may still have to be multiplied by."""
    plain = folded(words)
    named = words_for("factor").search(plain) and re.search(r"\d", plain)
    return bool(_FACTOR.search(plain) or named or words_for("part").search(plain))


def looks_like_unit(words: str) -> bool:
    """Tell a unit that is not known, such as ``kyd/s2``, from a remark, such as ``corrected`` or ``A1``."""
    plain = folded(words)
    if _SIGNS_OF_UNITS.search(plain) or has_factor(plain):
        return True
    if _SQUARE_SECONDS.search(plain) or _PART_OF_LETTERS.fullmatch(plain):
        return True
    longest = max(map(len, re.findall(r"[^\W\d_]+", plain)), default=0)
    numbered = re.search(r"\d", plain) is not None
    return not numbered and 0 < longest <= _LONGEST_UNIT and plain not in _REMARKS


def canonical_unit(words: str) -> str:
    """Return the one spelling used here for a unit, or the words themselves if it is unknown.

    ``CM/SEC/SEC``, ``cm/s^2``, ``cm/sec2``, ``cm s-2`` and ``gal`` all give ``cm/s2``.
    """
    return read_unit(words).name


def quantity_of(unit: str) -> str:
    """Return ``acceleration``, ``velocity``, ``force``, … for a unit, or ``""`` for one that no samples have.

    Those are unknown units, ones with a factor that may be meant either way, and units of time.
    """
    found = read_unit(unit)
    return "" if found.factor or found.quantity == "time" else found.quantity


def to_si(unit: str) -> float:
    """Return the factor from a unit of acceleration to m/s², NaN of words that are none."""
    found = read_unit(unit)
    return found.to_si if quantity_of(unit) == "acceleration" else math.nan


def asked_unit(unit: str) -> str:
    """Check a unit that the user named and return its canonical spelling.

    Parameters
    ----------
    unit
        In any usual writing.

    Returns
    -------
    str
        The one spelling used here, such as ``cm/s2`` for ``gal``.
    """
    if quantity_of(unit) != "acceleration":
        raise InputError(
            f"unit {unit!r} is not a unit of acceleration known here; give one of {', '.join(ASKED_UNITS)}."
        )
    return canonical_unit(unit)


_ENDINGS = {
    "acceleration": re.compile(r"\.acc\b"),
    "velocity": re.compile(r"\.(?:vel|vt2)\b"),
    "displacement": re.compile(r"\.(?:dis|dsp|dt2)\b"),
}
_NO_WORDS_OF_NAMES = frozenset({"dis", "weg", "speed"})
"""Words that in the name of a file may be a part of a place's name."""


def quantity_in_name(name: str) -> str:
    """Return the quantity that the name of a file or of a folder says it holds.

    Parameters
    ----------
    name
        Without the folders before it.

    Returns
    -------
    str
        ``acceleration``, ``velocity`` or ``displacement``; empty if the name says nothing.
    """
    plain = folded(name)
    parts = set(re.split(r"[-_. ]+", plain)) - _NO_WORDS_OF_NAMES
    for quantity, ending in _ENDINGS.items():
        if any(map(words_for(quantity).fullmatch, parts)) or ending.search(plain):
            return quantity
    return ""


_OF_THREE = re.compile(r"(?P<stem>.+[-_. ])(?P<letter>[avd])(?P<ending>\.\w+)?", re.I)
_LETTERS = {"v": "velocity", "d": "displacement"}


def others_of_three(names: Iterable[str]) -> dict[str, str]:
    """Return the files of velocity and displacement that lie beside one of acceleration.

    Parameters
    ----------
    names
        Of files with their folders. ``X.a``, ``X.v`` and ``X.d`` are one record in three quantities, and so are
        ``X_a.txt``, ``X_v.txt`` and ``X_d.txt``; a ``v`` without a ``d`` may be a direction.

    Returns
    -------
    dict
        ``velocity`` or ``displacement`` by the name of the file.
    """
    sets: dict[tuple[str, str], dict[str, str]] = {}
    for name in names:
        if parts := _OF_THREE.fullmatch(name):
            key = parts["stem"].lower(), (parts["ending"] or "").lower()
            sets.setdefault(key, {})[parts["letter"].lower()] = name
    whole = [found for found in sets.values() if found.keys() == {"a", "v", "d"}]
    return {found[letter]: _LETTERS[letter] for found in whole for letter in "vd"}
