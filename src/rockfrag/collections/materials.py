"""Densities of what solid objects are made of, by the words of museums in six languages.

In goes what a catalogue says of the material (``Carrara marble``, ``Kalkstein, Farbreste``); out comes a range of
densities [kg/m³] with its source, or nothing: of metals, vessels, glass and plaster casts nobody states how hollow
they are, and of two unlike materials not how much there is of each. Docs: ``docs/collections.md``.
"""

import re
from dataclasses import dataclass

BOLZ = "Bolz and Tuve 1973"
MARKS = "Marks 1967"
EUROCODE = "EN 1991-1-1 Annex A"


@dataclass(frozen=True)
class Solid:
    """A material of solid objects.

    Attributes
    ----------
    name : what it is called in docs
    low, high : range of its density [kg/m³]
    source : table that gives the range
    words : what catalogues call it
    wood : whether it is a kind of wood
    """

    name: str
    low: float
    high: float
    source: str
    words: tuple[str, ...]
    wood: bool = False

    @property
    def density(self) -> float:
        """Middle of the range [kg/m³]."""
        return 0.5 * (self.low + self.high)


def _wood(name: str, low: float, high: float, source: str, words: str) -> Solid:
    return Solid(name, low, high, source, tuple(words.split()), wood=True)


def _stone(name: str, low: float, high: float, source: str, words: str) -> Solid:
    return Solid(name, low, high, source, tuple(words.split()))


_WOOD = _wood(
    "wood, no kind stated", 320, 900, BOLZ, "wood holz bois legno madera hout"
)
SOLIDS = (
    _stone("marble", 2600, 2800, BOLZ, "marble marmor marbre marmo mármol marmer"),
    _stone(
        "slate", 2600, 2900, MARKS, "slate schiefer ardoise ardesia pizarra leisteen"
    ),
    _stone("granite", 2640, 2760, BOLZ, "granite granit granito graniet"),
    _stone(
        *("porphyry", 2600, 2900, MARKS),
        "porphyry porphyr porphyre porfido pórfido porfier",
    ),
    _stone("basalt", 2700, 3200, MARKS, "basalt basalte basalto"),
    _stone("diorite", 2750, 3160, EUROCODE, "diorite diorit"),
    _stone(
        *("limestone, travertine", 2100, 2900, MARKS),
        "limestone kalkstein calcaire calcare caliza kalksteen travertine travertin "
        "travertino",
    ),
    _stone(
        *("alabaster, of sulphate or carbonate", 2260, 2780, BOLZ),
        "alabaster albâtre alabastro albast",
    ),
    _stone(
        *("sandstone", 2140, 2360, BOLZ),
        "sandstone sandstein grès arenaria arenisca zandsteen",
    ),
    _stone(
        *("soapstone", 2600, 2800, BOLZ),
        "soapstone speckstein stéatite steatite esteatita",
    ),
    _stone(
        *("concrete", 2200, 2450, f"{BOLZ}; {EUROCODE}"),
        "concrete beton béton calcestruzzo hormigón",
    ),
    _WOOD,
    _wood("oak", 600, 900, BOLZ, "oak eiche eichenholz chêne quercia roble eik"),
    _wood("walnut", 600, 700, BOLZ, "walnut nussbaum noyer noce nogal"),
    _wood("mahogany", 560, 850, MARKS, "mahogany mahagoni acajou mogano caoba"),
    _wood("lime (basswood)", 320, 590, BOLZ, "limewood lindenholz tilleul tiglio"),
    _wood("pine", 400, 600, BOLZ, "pine kiefer kiefernholz pino grenen"),
)
"""What solid objects are made of: ranges as the sources print them, in kg/m³ (Annex A: kN/m³ over g)."""

_BY_WORD = {word: solid for solid in SOLIDS for word in solid.words}

HOLLOW = frozenset(
    (
        *("bronze", "bronzo", "bronce", "brons", "brass", "messing", "laiton", "ottone"),
        *("iron", "eisen", "fer", "ferro", "hierro", "ijzer", "steel", "stahl", "acier"),
        *("copper", "kupfer", "cuivre", "rame", "cobre", "koper", "lead", "blei", "plomb"),
        *("silver", "silber", "argent", "argento", "plata", "zilver", "aluminium"),
        *("porcelain", "porzellan", "porcelaine", "porcellana", "porcelana", "porselein"),
        *("terracotta", "terrakotta", "earthenware", "stoneware", "ceramic", "keramik"),
        *("céramique", "ceramica", "cerámica", "keramiek", "faience", "fayence", "maiolica"),
        *("steingut", "steinzeug", "clay", "ton", "argile", "argilla", "terre", "terra"),
        *("glass", "glas", "verre", "vetro", "vidrio", "wax", "wachs", "cire", "cera"),
        *("plaster", "gips", "gypsum", "plâtre", "gesso", "yeso", "stucco", "stuck"),
    )
)  # fmt: skip
"""Materials of which objects are mostly hollow, or nobody says."""

_WORD = re.compile(r"[^\W\d_]+")


def solid_of(material: str) -> Solid | None:
    """Return of what a solid object is by what its material is called.

    Parameters
    ----------
    material : what a catalogue says

    Returns
    -------
    The material; None where it is not known, mostly hollow, or more than one.
    """
    words = {word.casefold() for word in _WORD.findall(material)}
    found = {_BY_WORD[word] for word in words if word in _BY_WORD}
    if any(solid.wood and solid is not _WOOD for solid in found):
        # oak wood, bois de chêne
        found.discard(_WOOD)
    if len(found) != 1 or words & HOLLOW:
        return None
    return found.pop()
