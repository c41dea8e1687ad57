"""Dimensions that stand in a sentence, such as ``H 180 × W 60 × D 40 cm`` or ``70 7/8 x 24 in. (180 x 61 cm)``.

Museums write height, width and depth in any order, in centimetres and in inches with fractions, of the whole, of
the object without its base, of each of a pair. What is stated is read; what is not stated (which of three bare
numbers is the height) is asked and never guessed: a bookcase taken for its own side is another object.

In goes the text of a cell, out come :class:`Dimensions` in metres (``docs/collections.md``).
"""

import re
import unicodedata
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from rockfrag.base.errors import InputError
from rockfrag.collections.order_words import (
    DIRECTION_OF,
    WEIGHT_WORDS,
    Direction,
    directions,
)

METRES = {
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "in": 0.0254,
    "inch": 0.0254,
    "inches": 0.0254,
    '"': 0.0254,
    "ft": 0.3048,
    "feet": 0.3048,
    "foot": 0.3048,
    "'": 0.3048,
    **dict.fromkeys(("mms", "millimetre", "millimetres", "millimeters"), 1e-3),
    **dict.fromkeys(("cms", "centimetre", "centimetres", "centimeters"), 1e-2),
    **dict.fromkeys(("metre", "metres", "meter", "meters"), 1.0),
}
"""Metres of each unit of length."""

POUND = 0.45359237  # [kg]
KILOGRAMS = {
    **dict.fromkeys(("kg", "kgs", "kilogram", "kilograms", "kilo"), 1.0),
    **dict.fromkeys(("g", "gram", "grams"), 1e-3),
    **dict.fromkeys(("lb", "lbs", "pounds"), POUND),
    **dict.fromkeys(("oz", "ounces"), POUND / 16),
    "t": 1000.0,
}
"""Kilograms of each unit of mass."""

SAME = 0.02
"""Largest relative difference of one length in two units: catalogues round to an eighth of an inch, or to 1 mm."""

ROUNDED_M = 3e-3  # and the largest difference [m] that rounding alone explains

WITH_BASE = (
    *("with base", "including base", "incl. base", "overall", "installed"),
    *("mit sockel", "gesamt", "gesamtmaß", "avec socle", "hors tout"),
    *("con base", "complessivo", "total", "totale", "met sokkel", "totaal", "com base"),
    *("with stand", "with plinth", "with pedestal", "including stand"),
    *("including plinth", "including pedestal", "inkl. sockel", "con peana"),
    *("incl. plinth", "incl. pedestal", "incl. stand", "including the base"),
    *("including socle", "met voetstuk", "con plinto", "con zoccolo", "mit plinthe"),
)
WITHOUT_BASE = (
    *("without base", "excluding base", "ohne sockel", "sans socle"),
    *("senza base", "sin base", "zonder sokkel", "sem base", "sin peana"),
    *("without stand", "without plinth", "without pedestal"),
    *("excluding stand", "excluding plinth", "excluding pedestal"),
    *("excluding socle", "zonder voetstuk", "senza plinto", "senza zoccolo"),
    "ohne plinthe",
)
OBJECT = ("object", "sculpture", "figure", "statue", "objekt", "objet", "objeto")
FEET = (
    *("base", "plinth", "sockel", "standfläche", "fuß", "socle", "pied"),
    *("zoccolo", "piede", "sokkel", "voet"),
)
"""What an object stands on, by itself or of one piece with it."""
PIECES_OF_IT = (
    *FEET,
    *("rim", "mouth", "lip", "seat", "mündung", "orlo", "bocca", "embouchure"),
    *("pedestal", "frame", "framed", "unframed", "image", "sheet", "lid", "case"),
    *("head", "rahmen", "cadre", "cornice", "marco", "lijst", "deckel", "couvercle"),
    *("internal", "inner", "inside", "interior", "lichte", "innen", "interno"),
    *("intérieur", "intérieure", "interna", "binnen"),
)
EACH = ("each", "jeweils", "je", "chacun", "chacune", "ciascuno", "cada uno", "elk")
_SPECIFIC = ("", "with base", "each", "without base")
"""Parts from the least to the most specific; pieces of it are more so."""

_APPROXIMATE = re.compile(
    r"\b(?:approximately|approx|about|circa|ca|c|etwa|ungefähr|environ|env|aprox|ongeveer)\b\.?\s*"
)
_LARGEST = re.compile(
    r"\b(?:max|maximum|maximal|maximale|massim[oa]|máxim[oa])\b\.?\s*"
)
_FRACTIONS = {
    mark: unicodedata.normalize("NFKC", mark).replace("⁄", "/")
    for mark in "¼½¾⅓⅔⅛⅜⅝⅞⅙⅚⅕⅖⅗⅘"
}


def _any_of(words: Sequence[str]) -> str:
    """Pattern of any of several words, the longest first."""
    return "|".join(re.escape(word) for word in sorted(words, key=len, reverse=True))


_WAY = _any_of([*DIRECTION_OF])
_ORDER = _any_of([*DIRECTION_OF, *WEIGHT_WORDS])
_UNIT = _any_of([*METRES, *KILOGRAMS])
_PART = _any_of([*WITHOUT_BASE, *WITH_BASE, *PIECES_OF_IT, *EACH])
_WITH_OR_WITHOUT = _any_of([*WITHOUT_BASE, *WITH_BASE, *EACH])
_PIECE = _any_of(PIECES_OF_IT)
_METRIC = "cm|mm|m|kg"  # Units that Italian catalogues write before the number
_NUMBER = r"\d+(?:[.,]\d+)?(?:(?:\s+|-)\d+/\d+)?(?!\d)"
_ANY_NUMBER = rf"(?:\d+/\d+|{_NUMBER})"
_TERM = re.compile(
    rf"(?:(?<!\w)(?P<before>{_ORDER})(?![^\W\d_])[.:=\s]*)?"
    rf"(?:(?<!\w)(?P<first>{_METRIC})\.?\s*)?"
    rf"(?P<low>{_ANY_NUMBER})(?:\s*(?:-|\bto\b|\bbis\b|à)\s*(?P<high>{_ANY_NUMBER}))?"
    rf"(?:\s*(?P<unit>{_UNIT})(?![^\W\d_])\.?)?"
    rf"(?:\s*(?P<after>{_ORDER})(?![^\W\d_])\.?(?:\s*(?P<last>{_UNIT})(?![^\W\d_]))?)?"
)
_BETWEEN = re.compile(
    rf"(?<!\w)(?:between|from|zwischen|von|entre|de|tra|da|tussen|van)\s+({_ANY_NUMBER})\s*"
    rf"(?:and|to|und|bis|et|à|a|e|y|en|tot)\s+(?=\d)"
)
"""A range in words: between 30 and 45 cm, von 30 bis 45 cm."""

_TWO_LANGUAGES = re.compile(
    rf"(?<!\w)({_WAY})\.?\s*/\s*({_WAY})(?!\w)\.?\s*[:=]?\s*(?=\d)"
)
_ORDER_IN_ONE = re.compile(r"(?<!\w)(?=[a-z]*h)[hwdbtlp]{3}(?!\w)")
"""Three letters of an order without signs: HWD, HBT, LBH."""

_METRES_FIRST = re.compile(r"(?<![\d.,])(\d)\s*m\.?\s*(\d\d)(?=\s*(?:$|[;,)×x](?!\d)))")
"""1 m 80, of which the second number are centimetres."""

_LETTERED = [re.compile(rf"(?<!\w)(?:\({name}\)|{name}[:)])") for name in "ab"]
"""Marks of two parts with sizes of their own: (a), (b)."""

_UNIT_ALONE = re.compile(rf"(?:all )?(?:in )?({_any_of([*METRES])})\.?")
_ORDER_ALONE = re.compile(
    rf"(?<!\w)((?:{_WAY})\.?(?:\s*[×/,]\s*(?:{_WAY})\.?)+)(?!\w)\s*[:=]?"
)


_NAMED = [
    (
        re.compile(rf"(?:{_any_of(names)})(?!\w)"),
        re.compile(rf"\d.*[\s,]({_any_of(names)})$"),
        stands_for,
    )
    for names, stands_for in (
        (WITHOUT_BASE, "without base"),
        (WITH_BASE, "with base"),
        (OBJECT, ""),
        (EACH, "each"),
        (PIECES_OF_IT, None),
    )
]
"""Patterns of the parts that a piece names first or last, and what they stand for; None for themselves."""


@dataclass(frozen=True)
class Length:
    """One stated length.

    Attributes
    ----------
    low, high : its limits [m], equal unless a range is stated
    """

    low: float
    high: float

    @property
    def middle(self) -> float:
        """Middle of the limits [m]."""
        return 0.5 * (self.low + self.high)


@dataclass(frozen=True)
class Dimensions:
    """Size of an object as a text states it.

    Attributes
    ----------
    height, width, depth, diameter : lengths that are stated; None where they are not
    mass : mass [kg]; None where it is not stated
    part : what the lengths are of, such as ``with base``; empty where the text does not say
    others : sizes of other parts, as they stand
    approximate : whether the text says that they are about so
    question : what has to be asked before the lengths can be used; empty where nothing has
    """

    height: Length | None = None
    width: Length | None = None
    depth: Length | None = None
    diameter: Length | None = None
    mass: float | None = None
    part: str = ""
    others: tuple[str, ...] = ()
    approximate: bool = False
    question: str = ""

    def with_lengths(self, lengths: Mapping[str, Length]) -> "Dimensions":
        """Return the same with these lengths, by ``height``, ``width``, ``depth`` and ``diameter``."""
        return replace(
            self,
            height=lengths.get("height"),
            width=lengths.get("width"),
            depth=lengths.get("depth"),
            diameter=lengths.get("diameter"),
        )

    @property
    def understood(self) -> str:
        """What was understood, in words."""
        said = [
            f"{name} {_centimetres(length)}"
            for name in ("height", "width", "depth", "diameter")
            if (length := getattr(self, name)) is not None
        ]
        if self.mass is not None:
            said.append(f"mass {self.mass:.4g} kg")
        text = ", ".join(said) or "nothing"
        return f"{text} ({self.part})" if self.part else text


@dataclass(frozen=True)
class _Stated:
    """A length as it stands: limits in its unit, and the word beside it."""

    low: float
    high: float
    unit: str
    word: str

    def metres(self) -> Length:
        factor = METRES[self.unit]
        return Length(factor * self.low, factor * self.high)


@dataclass(frozen=True)
class _Phrase:
    """A piece of the text: lengths that belong together, and the part of the object that they are of."""

    text: str
    part: str = ""
    lengths: tuple[_Stated, ...] = ()
    order: tuple[str, ...] = ()
    mass: float | None = None
    unit_missing: bool = False

    @property
    def is_foot(self) -> bool:
        """Whether it measures on what the object stands, and no piece of its own."""
        words = {DIRECTION_OF.get(length.word) for length in self.lengths}
        flat = len(self.lengths) < 3 and Direction.HEIGHT not in words
        return self.part in FEET and flat


def read_dimensions(text: str, order: str = "") -> Dimensions:
    """Read the size of an object out of a sentence.

    Parameters
    ----------
    text : what a catalogue says
    order : directions of lengths that the text does not name, such as ``HWD``, if it is known of the whole table

    Returns
    -------
    What is stated. Where ``question`` is not empty no length is given.

    Raises
    ------
    InputError
        If ``order`` has a letter that is no direction.
    """
    for letter in order:
        if letter.casefold() not in DIRECTION_OF:
            raise InputError(
                f"order: expected letters of height, width, depth or length such as HWD, got {order!r}."
            )
    if all(mark.search(text.casefold()) for mark in _LETTERED):
        question = "parts a and b have sizes of their own; give each a row"
        return Dimensions(question=question)
    phrases = _with_stated_unit(list(_phrases(_plain(text))))
    masses = [phrase.mass for phrase in phrases if phrase.mass is not None]
    about = Dimensions(
        # of a mass of 0 nothing is known
        mass=(masses[0] or None) if masses else None,
        approximate=bool(_APPROXIMATE.search(text.casefold())),
    )
    measured = [phrase for phrase in _with_orders(phrases, order) if phrase.lengths]
    if not measured:
        return replace(
            about, question="no length is stated; give height, width and depth"
        )
    part = min((phrase.part for phrase in measured), key=_rank_of_part)
    kept = {part, ""} if _names_all(measured, part) else {part}
    own = [phrase for phrase in measured if phrase.part in kept]
    others = [phrase.text for phrase in measured if phrase.part not in kept]
    about = replace(about, part=part, others=tuple(others))
    if part in PIECES_OF_IT:
        return replace(
            about, question=f"only the {part} is measured; give the size of the whole"
        )
    if foot := next((phrase for phrase in measured if phrase.is_foot), None):
        asked = f"“{foot.text}” is said of its {foot.part}; give the sides on which it stands"
        return replace(about, question=asked)
    return _joined(about, own)


def _plain(text: str) -> str:
    """Text in small letters, with one sign each for times, ranges, inches and feet, and plain fractions."""
    for mark, digits in _FRACTIONS.items():
        text = re.sub(rf"(\d)\s*{mark}", rf"\1 {digits}", text).replace(mark, digits)
    text = re.sub("[″”“]|''|’’", '"', text.replace("⁄", "/"))
    text = re.sub("[′’‘]", "'", text)
    text = re.sub("[–—−]", "-", text)
    text = re.sub(r"[✕✖*]", "×", text).replace("⌀", "ø").replace("\u00a0", " ")
    # of ß there is no small letter to be made
    text = text.replace("ß", "\x00").casefold().replace("\x00", "ß")
    text = _LARGEST.sub("", _APPROXIMATE.sub("", text))
    text = re.sub(r"\(\s*\)", " ", text)
    # .60 m, but not H.60 cm
    text = re.sub(r"(?:^|(?<=[\s×x(,;:]))\.(?=\d)", "0.", _plain_masses(text))
    text = _METRES_FIRST.sub(r"\1.\2 m", text)
    text = _ORDER_IN_ONE.sub(lambda found: " × ".join(found[0]), text)
    text = _BETWEEN.sub(r"\1 - ", text)
    text = _TWO_LANGUAGES.sub(_said_twice, text)
    # hauteur en cm : 180
    text = re.sub(
        rf"(?<!\w)({_WAY})\.?\s+(?:en|in)\s+(mm|cm|m)[.\s:=]*({_ANY_NUMBER})",
        r"\1 \3 \2",
        text,
    )
    # height with base: 180 cm, height (with base): 180 cm; rim diameter 20 cm: a part of its own
    text = re.sub(
        rf"(?<!\w)({_ORDER})\.?\s*(?:\s|\()\s*({_WITH_OR_WITHOUT})[\s:.)]*(?=\d)",
        r"; \2: \1 ",
        text,
    )
    text = re.sub(rf"(?<=[\s,])({_PIECE})\s+(?=(?:{_ORDER})(?!\w))", r"; \1 ", text)
    # 180 (H) x 60 (W): a word in brackets is the word of the number before it
    text = re.sub(rf"\(\s*({_ORDER})\.?\s*\)", r" \1 ", text)
    # H 180 cm (with base): a part in brackets is what the lengths before it are of
    text = re.sub(rf"\(\s*({_PART})\s*\)", r" \1", text)
    # HxWxD, 60x40, 60cmx40cm: an x between directions, numbers and units is a sign
    before = rf"(?:{_ORDER}|{_UNIT}|\d|\.|\))"
    previous = None
    while previous != text:
        previous = text
        text = re.sub(
            rf"(?<![^\W\d_])({before}\.?)\s*x\s*(?=(?:{_ORDER}|\d))", r"\1 × ", text
        )
        text = re.sub(rf"(?<=\d)({_UNIT})\.?\s*x\s*(?=(?:{_ORDER}|\d))", r"\1 × ", text)
    return re.sub(r"\bby\b", "×", text)


def _said_twice(found: re.Match[str]) -> str:
    """Return the first of two words for one direction: höhe/height; both where they are of two."""
    same = DIRECTION_OF[found[1]] == DIRECTION_OF[found[2]]
    return f"{found[1]} " if same else found[0]


def _plain_masses(text: str) -> str:
    """Text whose masses have no sign between thousands; one that may be such a sign or a decimal one says nothing.

    Which it is shows in the other numbers: 1.250 kg beside 2,10 m is more than a ton.
    """
    marks = set(re.findall(r"\d([.,])(?:\d{1,2}|\d{4,})(?!\d)", text))
    mass = r"(?<![\d.,])(\d{1,3})([.,])(\d{3})(\s*(?:kg|kgs|kilograms?|lbs?|g))(?!\w)"

    def without_sign(found: re.Match[str]) -> str:
        """A number without the marks between its thousands; nothing where these may be decimals."""
        if marks == {found[2]}:
            return found[0]
        american = found[2] == "," and found[4].strip().startswith("lb")
        return f"{found[1]}{found[3]}{found[4]}" if len(marks) == 1 or american else ""

    return re.sub(mass, without_sign, text)


def _with_stated_unit(phrases: list[_Phrase]) -> list[_Phrase]:
    """Give phrases without a unit the one that stands alone: H x W (cm): 180 x 60."""
    alone = {
        found[1] for each in phrases if (found := _UNIT_ALONE.fullmatch(each.text))
    }
    if len(alone) != 1:
        return phrases
    (unit,) = alone
    return [
        replace(
            each,
            lengths=tuple(replace(length, unit=unit) for length in each.lengths),
            unit_missing=False,
        )
        if each.unit_missing
        else each
        for each in phrases
    ]


def _phrases(text: str) -> Iterator[_Phrase]:
    """Yield the pieces of a text, each with its lengths and the part of the object that it is of."""
    part = ""
    for piece in re.split(r"[;\n|()\[\]]", text):
        named, words = _split_part(piece.strip(" .,:"))
        part = part if named is None else named
        if words:
            yield _read_phrase(words, part)


def _split_part(words: str) -> tuple[str | None, str]:
    """Part of the object that a piece names first or last, None without one, and the rest of the piece."""
    for first, last, stands_for in _NAMED:
        if found := first.match(words):
            part, rest = found[0], words[found.end() :]
        elif found := last.search(words):
            part, rest = found[1], words[: found.start(1)]
        else:
            continue
        within, rest = _split_part(rest.strip(" .,:"))
        part = part if stands_for is None else stands_for
        # overall, without base: the more specific one
        return max(part, within or "", key=_how_specific), rest
    return None, words


def _how_specific(part: str) -> int:
    """How much of an object a part leaves out, in order."""
    return _SPECIFIC.index(part) if part in _SPECIFIC else len(_SPECIFIC)


def _names_all(phrases: Sequence[_Phrase], part: str) -> bool:
    """Whether a part that only the last lengths name is that of all lengths: H 180 cm; W 60 cm (with base).

    It is not where these lengths repeat one of those before: H 180 cm; H 190 cm (with base).
    """
    words: dict[bool, set[str]] = {True: set(), False: set()}
    for phrase in phrases:
        words[bool(phrase.part)].update(each.word for each in phrase.lengths)
    is_only_part = {phrase.part for phrase in phrases} == {"", part}
    is_whole = part not in EACH and part not in PIECES_OF_IT
    return is_only_part and is_whole and words[True].isdisjoint(words[False])


def _rank_of_part(part: str) -> int:
    """Order in which parts are taken: what stands on the floor first."""
    ranks = ("with base", "", "each", "without base")
    return ranks.index(part) if part in ranks else len(ranks)


def _read_phrase(words: str, part: str) -> _Phrase:
    """Read the lengths, the mass and the order of sides of one piece.

    Every term is a number or a range with the word for its side and its unit; it is a mass, the rest of the length
    before it (5 ft 3 in), or a length of its own.

    Parameters
    ----------
    words : of the piece
    part : what it is of, empty for the whole object
    """
    order: tuple[str, ...] = ()
    if alone := _ORDER_ALONE.search(words):
        order = tuple(re.findall(rf"(?<!\w)(?:{_ORDER})(?!\w)", alone[1]))
        words = words[: alone.start()] + words[alone.end() :]
    terms = list(_TERM.finditer(words))
    # H 180 W 60 or 180 H 60 W: the first number tells on which side its word stands
    side = "before" if terms and terms[0]["before"] else "after"
    lengths: list[_Stated] = []
    mass = None
    stated = [term["unit"] or term["last"] or term["first"] or "" for term in terms]
    of_lengths = next((unit for unit in stated if unit in METRES), "")
    for i, term in enumerate(terms):
        unit = stated[i]
        low = _number(term["low"], unit or of_lengths)
        high = _number(term["high"], unit or of_lengths) if term["high"] else low
        word = term[side] or ""
        if side == "before" and not word and i and terms[i - 1]["after"]:
            # the word between two numbers belongs to the second
            word = terms[i - 1]["after"]
        if word in WEIGHT_WORDS or unit in KILOGRAMS:
            ounces = KILOGRAMS.get(unit) == KILOGRAMS["oz"]
            weight = KILOGRAMS.get(unit, 1.0) * 0.5 * (low + high)
            mass = weight + (mass or 0.0 if ounces else 0.0)
        elif lengths and _continues(
            lengths[-1], unit, _between(words, terms[i - 1], term)
        ):
            joined = _in_the_smaller(lengths[-1], low, unit)
            lengths[-1] = replace(joined, word=joined.word or word)
        else:
            lengths.append(_Stated(low, high, unit, word))
    units = [length.unit for length in lengths if length.unit]
    if units:
        lengths = _with_units(lengths)
    return _Phrase(
        words, part, tuple(lengths), order, mass, bool(lengths and not units)
    )


def _between(words: str, before: re.Match[str], term: re.Match[str]) -> str:
    """Text between two numbers with their units, words beside them included."""
    start = before.end("unit") if before["unit"] else before.end()
    return words[start : term.start("low")]


def _continues(before: _Stated, unit: str, between: str) -> bool:
    """Whether a smaller unit goes on what a larger one began: 6 ft 2 in., 1 m 20 cm."""
    pair = METRES.get(before.unit), METRES.get(unit)
    known = pair in ((METRES["ft"], METRES["in"]), (METRES["m"], METRES["cm"]))
    return known and not between.strip(" .-")


def _in_the_smaller(larger: _Stated, value: float, unit: str) -> _Stated:
    """One length of feet and inches in inches, or of metres and centimetres in centimetres."""
    times = METRES[larger.unit] / METRES[unit]
    low, high = times * larger.low + value, times * larger.high + value
    return replace(larger, low=low, high=high, unit=unit)


def _with_units(lengths: Sequence[_Stated]) -> list[_Stated]:
    """Give lengths without a unit that of the next one that has it, or of the last."""
    found: list[_Stated] = []
    unit = next(length.unit for length in reversed(lengths) if length.unit)
    for length in reversed(lengths):
        unit = length.unit or unit
        found.append(replace(length, unit=unit))
    return found[::-1]


def _number(text: str, unit: str) -> float:
    """Read ``70 7/8``, ``1,8`` or ``1,800`` (of millimetres)."""
    whole, _, fraction = text.replace("-", " ").rpartition(" ")
    if "/" not in fraction:
        whole, fraction = fraction, ""
    if re.fullmatch(r"\d{1,3}[.,]\d{3}", whole) and METRES.get(unit) == METRES["mm"]:
        whole = re.sub("[.,]", "", whole)
    value = float(whole.strip().replace(",", ".")) if whole.strip() else 0.0
    if fraction:
        above, below = fraction.split("/")
        if not float(below):
            return 0.0
        value += float(above) / float(below)
    return value


def _with_orders(phrases: Sequence[_Phrase], order: str) -> list[_Phrase]:
    """Give each phrase of bare numbers the order that stands alone beside it, or the one that is known."""
    alone = next((phrase.order for phrase in phrases if phrase.order), tuple(order))
    found = []
    for phrase in phrases:
        bare = not any(length.word for length in phrase.lengths)
        given = phrase.order or alone
        if bare and len(given) == len(phrase.lengths):
            lengths = [
                replace(length, word=word.casefold())
                for length, word in zip(phrase.lengths, given, strict=True)
            ]
            phrase = replace(phrase, lengths=tuple(lengths))
        found.append(phrase)
    return found


def _joined(about: Dimensions, phrases: Sequence[_Phrase]) -> Dimensions:
    """Join what several phrases say of one part, or ask."""
    if any(phrase.unit_missing for phrase in phrases):
        return replace(about, question="no unit stands beside the lengths; give it")
    kept: list[_Stated] = []
    for phrase in phrases:
        restated = _restates(kept, phrase.lengths)
        if restated is None:
            text = "; ".join(phrase.text for phrase in phrases)
            return replace(
                about,
                question=f"the sizes “{text}” differ, or one has no side; say which is the object's",
            )
        kept = restated
    words = [length.word for length in kept]
    if not all(words):
        return replace(
            about,
            question="which length is the height and which a side is not stated; give their order",
        )
    stated = directions(words)
    if stated is None:
        named = " × ".join(word.upper() for word in words)
        return replace(about, question=f"{named} leaves open which length is which")
    if not all(length.low > 0 for length in kept):
        return replace(about, question="a length of 0 is no size; leave it out")
    by_way = dict(zip(stated, (length.metres() for length in kept), strict=True))
    return about.with_lengths(_placed(by_way))


def _restates(kept: Sequence[_Stated], more: Sequence[_Stated]) -> list[_Stated] | None:
    """Lengths that were known with those of one phrase more; None where they contradict each other.

    A phrase of as many lengths as were known says the same in another unit, or speaks of something else.
    """
    if not kept:
        return list(more)
    named, bare = all(each.word for each in more), not any(each.word for each in kept)
    if named and bare and len(kept) == len(more):
        same = all(map(_same, kept, more))
        return list(more) if same else None
    known = {length.word: length for length in kept if length.word}
    added = [length for length in more if length.word and length.word not in known]
    if len(added) == len(more):
        return [*kept, *added]
    again = [length for length in more if length not in added]
    against = [known.get(length.word) for length in again]
    if not all(length.word for length in again):
        # the last ones, as in H. 70 in. (178 cm); W. 24 in. (61 cm)
        against = list(kept[-len(again) :])
    found = list(kept)
    for length, other in zip(again, against, strict=True):
        if other is None or not _same(length, other):
            return None
        if METRES[length.unit] in (1e-3, 1e-2, 1.0):
            found[found.index(other)] = replace(length, word=other.word)
    return [*found, *added]


def _same(first: _Stated, second: _Stated) -> bool:
    a, b = first.metres().middle, second.metres().middle
    return abs(a - b) <= max(SAME * max(a, b), ROUNDED_M)


def _placed(lengths: dict[Direction, Length]) -> dict[str, Length]:
    """Lengths by the field that they fill: a length lies along whichever side is free, the width first."""
    found = dict(lengths)
    length = found.pop(Direction.LENGTH, None)
    if length is not None:
        free = Direction.DEPTH if Direction.WIDTH in found else Direction.WIDTH
        found[free] = length
    return {way.value: size for way, size in found.items()}


def _centimetres(length: Length) -> str:
    """A length in words, such as ``180 cm`` or ``178 to 182 cm``."""
    low, high = 100 * length.low, 100 * length.high
    return f"{low:.4g} cm" if low == high else f"{low:.4g} to {high:.4g} cm"
