"""Densities of what solid objects are made of, by the words of museums in six languages.

In goes what a catalogue says of the material (``Carrara marble``, ``Kalkstein, Farbreste``); out comes a density
[kg/m³], or nothing: of metals, vessels and glass nobody states how hollow they are, and of two unlike materials
not how much there is of each. Middle values of what tables of building stones and timbers give; a stone varies by
a tenth about them. Docs: ``docs/collections.md``.
"""

import re
from collections.abc import Mapping

_SOLID: Mapping[float, tuple[str, ...]] = {
    2700.0: (
        *("marble", "marmor", "marbre", "marmo", "mármol", "marmer"),
        *("slate", "schiefer", "ardoise", "ardesia", "pizarra", "leisteen"),
    ),
    2650.0: (
        *("granite", "granit", "granito", "graniet", "gneiss"),
        *("porphyry", "porphyr", "porphyre", "porfido", "pórfido", "porfier"),
    ),
    2900.0: ("basalt", "basalte", "basalto", "diorite", "diorit"),
    2300.0: (
        *("limestone", "kalkstein", "calcaire", "calcare", "caliza", "kalksteen"),
        *("alabaster", "albâtre", "alabastro", "albast"),
        *("travertine", "travertin", "travertino"),
        *("concrete", "beton", "béton", "calcestruzzo", "hormigón"),
    ),
    2250.0: ("sandstone", "sandstein", "grès", "arenaria", "arenisca", "zandsteen"),
    2750.0: ("soapstone", "speckstein", "stéatite", "steatite", "esteatita"),
    1200.0: ("plaster", "gips", "gypsum", "plâtre", "gesso", "yeso"),
    650.0: (
        *("wood", "holz", "bois", "legno", "madera", "hout", "oak", "eiche", "chêne"),
        *("limewood", "lindenholz", "tilleul", "tiglio", "walnut", "nussbaum", "noyer"),
        *("eichenholz", "noce", "nogal", "eik", "pine", "mahogany", "mahagoni", "acajou"),
    ),
}  # fmt: skip
_DENSITY = {word: density for density, words in _SOLID.items() for word in words}

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
    )
)  # fmt: skip
"""Materials of which objects are mostly hollow, or nobody says."""

_WORD = re.compile(r"[^\W\d_]+")


def density_of(material: str) -> float | None:
    """Return the density of a solid object by what its material is called.

    Parameters
    ----------
    material : what a catalogue says

    Returns
    -------
    The density [kg/m³]; None where the material is not known, mostly hollow, or more than one.
    """
    words = {word.casefold() for word in _WORD.findall(material)}
    found = {_DENSITY[word] for word in words if word in _DENSITY}
    if len(found) != 1 or words & HOLLOW:
        return None
    return found.pop()
