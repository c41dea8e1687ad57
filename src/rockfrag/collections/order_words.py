"""Words by which catalogues say which way a length lies, in the languages of museums.

English, German, French, Italian, Spanish, Portuguese, Dutch and the languages of Scandinavia. A letter may
mean different things in different languages: L is *length* beside a width (L × W × H), and *largeur* or
*larghezza* where depth is P (H × L × P). Which it is follows from the letters beside it (:func:`directions`),
never from the language, which a table does not state.
"""

from collections.abc import Sequence
from enum import Enum


class Direction(Enum):
    """Which way a length lies."""

    HEIGHT = "height"
    WIDTH = "width"
    DEPTH = "depth"
    LENGTH = "length"
    DIAMETER = "diameter"


_WORDS = {
    Direction.HEIGHT: (
        *("h", "ht", "hgt", "height", "high", "tall"),
        *("höhe", "hoehe", "hoch", "hauteur", "haut"),
        *("altezza", "alt", "altura", "alto", "hoogte", "hoog"),
        *("gesamthöhe", "højde", "höjd", "høyde"),
    ),
    Direction.WIDTH: (
        *("w", "wd", "width", "wide", "b", "br", "breite", "breit", "largeur", "larg"),
        *("larghezza", "largh", "ancho", "anchura", "breedte", "breed"),
        *("gesamtbreite", "largura", "bredde", "bredd"),
    ),
    Direction.DEPTH: (
        *("d", "dp", "depth", "deep", "t", "tiefe", "tief", "p", "prof", "profondeur"),
        *("profondità", "profundidad", "fondo", "diepte", "diep", "thickness", "thick"),
        *("dicke", "épaisseur", "spessore", "grosor", "dikte", "ép", "spess"),
        "profundo",
        *("pr", "gesamttiefe", "profundidade", "espessura", "dybde", "djup"),
    ),
    Direction.LENGTH: (
        *("l", "lg", "length", "long", "länge", "laenge", "lang", "longueur"),
        *("lunghezza", "lungh", "longitud", "largo", "lengte"),
        *("gesamtlänge", "comprimento", "længde", "längd", "lengde"),
    ),
    Direction.DIAMETER: (
        *("ø", "⌀", "diam", "dia", "dm", "diameter", "durchmesser", "diamètre"),
        *("diametro", "diámetro", "doorsnede", "durchm", "diâmetro"),
    ),
}

DIRECTION_OF = {word: way for way, words in _WORDS.items() for word in words}
"""Direction of each word, in small letters."""

WEIGHT_WORDS = frozenset(
    (
        *("wt", "weight", "mass", "gewicht", "gew", "poids", "peso", "masse"),
        *("massa", "vægt", "vikt", "vekt"),
    )
)
"""Words before a mass."""


def directions(words: Sequence[str]) -> list[Direction] | None:
    """Return which way each of several lengths lies, as the words beside them say together.

    Parameters
    ----------
    words : the word of each length, in any case, such as ``["H", "L", "P"]``

    Returns
    -------
    A direction for each word; None where they leave it open, as ``["H", "D"]`` do: D is the depth of a thing that
    has a width, and the diameter of one that has none.
    """
    found = [DIRECTION_OF[word.casefold()] for word in words]
    letters = [word.casefold() for word in words]
    if "l" in letters and Direction.WIDTH not in found:
        # H × L × P: largeur, larghezza
        found[letters.index("l")] = Direction.WIDTH
    if "d" in letters and not {Direction.WIDTH, Direction.LENGTH} & set(found):
        return None
    return found if len(set(found)) == len(found) else None
