"""Kinds of things that people ask about, each with usual sizes: a start for who has not measured yet.

In: the name of a kind, and what is known of the thing at hand. Out: sizes [m], mass [kg] and centre of gravity
where they are not given. The numbers are round values of common makes, assumed and not measured: an answer with
them is about a usual thing of the kind. ``docs/how-to/kinds.md`` says what to measure first.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from rockfrag.base.errors import InputError
from rockfrag.system.blocks import Block


@dataclass(frozen=True)
class Kind:
    """A kind of thing: usual sizes and weight.

    Attributes
    ----------
    title : in words
    width_m, depth_m, height_m : across the direction in which it topples most easily, along it, and upwards [m]
    density : mass over the volume of its outline [kg/m³]
    cg_fraction : height of the centre of gravity over its own [-]
    friction : usual coefficient of friction on what it stands on [-]
    round : whether base and outline are round
    """

    title: str
    width_m: float
    depth_m: float
    height_m: float
    density: float
    cg_fraction: float
    friction: float
    round: bool = False

    def settings(self, given: Mapping[str, Any]) -> dict[str, Any]:
        """Complete what is given of a thing by what is usual.

        Parameters
        ----------
        given : keys as of ``statue.yaml`` in SI units, such as ``width_m``

        Returns
        -------
        The given keys, and those of sizes, mass and centre of gravity that were not given. Mass and
        ``cg_height_m`` follow from the sizes; the usual depth counts for the mass alone, so that the thing
        topples in the plane of its width unless a depth is given.
        """
        if "mesh" in given:
            raise InputError(
                "key kind: the mesh says all sizes; leave one of both out."
            )
        is_round = bool(given.get("round", self.round))
        made: dict[str, Any] = {"width_m": self.width_m, "height_m": self.height_m}
        if is_round:
            made["round"] = True
        made |= given
        if is_round:
            area = math.pi / 4 * made["width_m"] ** 2
        else:
            area = made["width_m"] * made.get("depth_m", self.depth_m)
        volume = area * made["height_m"]
        usual = {
            "mass_kg": self.density * volume,
            "cg_height_m": self.cg_fraction * made["height_m"],
        }
        return usual | made


KINDS = {
    "bookcase": Kind("bookcase, filled", 0.30, 0.80, 2.00, 340.0, 0.48, 0.4),
    "server-rack": Kind("server rack, 42 units", 0.60, 1.00, 2.00, 500.0, 0.45, 0.4),
    "gas-cylinder": Kind(
        "gas cylinder of 50 l, steel", 0.229, 0.229, 1.64, 1050.0, 0.50, 0.4, round=True
    ),
    "bust": Kind("marble bust on its socle", 0.22, 0.20, 0.60, 1700.0, 0.58, 0.5),
    "tombstone": Kind("tombstone of granite", 0.15, 0.60, 0.90, 2700.0, 0.50, 0.6),
    "rock": Kind("precarious rock", 0.80, 0.80, 1.50, 1700.0, 0.50, 0.7),
    "pallet": Kind("loaded pallet", 0.80, 1.20, 1.60, 400.0, 0.50, 0.45),
}
"""Kinds by name."""


def kind_named(name: str) -> Kind:
    """Return the kind of a name.

    Parameters
    ----------
    name : such as ``bookcase``

    Returns
    -------
    The :class:`Kind`.
    """
    if name not in KINDS:
        raise InputError(f"kind: {name!r} is none of {', '.join(KINDS)}.")
    return KINDS[name]


def block_of_kind(name: str, **known: float) -> Block:
    """Make a usual thing of a kind, with what is known of the one at hand.

    Parameters
    ----------
    name : such as ``bookcase``
    **known : ``width``, ``depth``, ``height``, ``cg_height`` [m] and ``mass`` [kg] that were measured

    Returns
    -------
    The block: in a plane, and in space where a depth is given or the kind is round.

    Examples
    --------
    >>> from rockfrag.system import block_of_kind
    >>> bookcase = block_of_kind("bookcase", height=1.8)
    >>> bookcase.width, bookcase.height, round(bookcase.mass)
    (0.3, 1.8, 147)
    """
    units = {"mass": "kg"}
    unknown = set(known) - {"width", "depth", "height", "cg_height", "mass"}
    if unknown:
        raise InputError(
            f"block_of_kind: no argument is called {min(unknown)}; it has width, depth, height, cg_height "
            "and mass."
        )
    given = {f"{key}_{units.get(key, 'm')}": value for key, value in known.items()}
    found = kind_named(name).settings(given)
    return Block(
        found["width_m"],
        found["height_m"],
        found["mass_kg"],
        cg_height=found["cg_height_m"],
        depth=found.get("depth_m"),
        round=found.get("round", False),
    )
