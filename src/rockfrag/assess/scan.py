"""A scanned object as it may stand: drawn ways, in the order of the angle at which they balance.

Which points carry, how far in edges carry and where the object faces are not known; each has a distribution
(:mod:`rockfrag.campaign.standing`) unless it was measured.  The way in the middle stands for the object, and each
unknown moves along the order by its part of the variance of normal scores (Saltelli et al. 2008, first-order
effects; of the order, since a foot that carries from some tolerance on makes the angle jump).

In: a mesh [m] and what was measured. Out: arrangements of the object, with probabilities.
Docs: ``docs/assess.md``, "Scans".
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.assess.assumed import Assumption, assume
from rockfrag.campaign.standing import (
    LEAST_ANGLE_DEG,
    body_of,
    draw_arrangements,
    lognormal,
    unknowns_of,
)
from rockfrag.fragility.model_error import SCAN
from rockfrag.system.blocks import Block
from rockfrag.system.body import RigidBody
from rockfrag.system.mesh import Shape, edge_distances
from rockfrag.words.findings import two

SOURCE_OF = {
    "contact_tolerance_mm": "contact",
    "edge_retreat_mm": "retreat",
    "direction_deg": "facing",
}
"""Sources of uncertainty by the unknown."""

ARRANGEMENTS = 256  # Ways to stand that are drawn

# Relative standard deviation of a given contact tolerance: of ours
KNOWN_CONTACT_SPREAD = 0.2

_BINS = 8


@dataclass(frozen=True, eq=False)
class Scan:
    """A scan, and the ways in which it may stand."""

    shape: Shape  # The scan
    # A row each, by rising angle of balance, in its direction or the least
    arrangements: pd.DataFrame
    # Part of the variance of the order by source; the sum is 1
    parts: Mapping[str, float]
    # Column with that angle: ``alpha_deg``, or in space ``least_deg``
    order: str = "alpha_deg"
    # The ways in the order of space; None if it could not stand
    space: "Scan | None" = None

    def row_at(self, fraction: float) -> Mapping[str, float]:
        """The way below which a fraction of all balances."""
        place = min(int(fraction * len(self.arrangements)), len(self.arrangements) - 1)
        return {
            str(key): float(value)
            for key, value in self.arrangements.iloc[place].items()
        }

    def block(self, fraction: float = 0.5) -> Block:
        """The planar block of such a way."""
        return body_of(self.shape, self.row_at(fraction)).blocks[-1]

    def body(self, fraction: float = 0.5, turned_deg: float = 0.0) -> RigidBody:
        """The body in space of such a way."""
        way = self.row_at(fraction)
        tolerance = way["contact_tolerance_mm"] / 1e3
        retreat = way["edge_retreat_mm"] / 1e3
        return self.shape.body(way["direction_deg"] - turned_deg, tolerance, retreat)

    def sides(self) -> dict[str, tuple[float, float, float]]:
        """What each source does to the way to stand, by its name.

        That is the place of the way one standard deviation of the source lower among all ways, ordered, the place
        of that one higher [-, 0 to 1 each], and half of the distance between both in ln of what they are ordered
        by.
        """
        found = {}
        for name, part in self.parts.items():
            low, high = special.ndtr(-math.sqrt(part)), special.ndtr(math.sqrt(part))
            angles = [self.row_at(at)[self.order] for at in (low, high)]
            found[name] = (float(low), float(high), math.log(angles[1] / angles[0]) / 2)
        return found


def _known_exactly(mesh: Mapping[str, Any]) -> dict[str, float]:
    """What of the ways to stand is stated, and not drawn: how far edges retreat [mm], and the direction [°]."""
    exact = {}
    if "edge_retreat_m" in mesh:
        exact["edge_retreat_mm"] = 1e3 * mesh["edge_retreat_m"]
    if "direction_deg" in mesh:
        exact["direction_deg"] = float(mesh["direction_deg"])
    return exact


def make_scan(
    shape: Shape, mesh: Mapping[str, Any], contact_spread: float | None
) -> tuple[Scan, list[Assumption]]:
    """Draw the ways in which a scan may stand; return them, and what was assumed.

    ``mesh`` may have ``contact_tolerance_m``, ``edge_retreat_m``, ``direction_deg`` and ``scan_accuracy_m``,
    ``contact_spread`` is the relative standard deviation of the contact tolerance, if one was stated.
    """
    accuracy = mesh.get("scan_accuracy_m")
    unknowns = unknowns_of(SCAN, None if accuracy is None else 1e3 * accuracy)
    median = unknowns["contact_tolerance_mm"](0.5)
    del unknowns["restitution_ratio"]
    exact = _known_exactly(mesh)
    given = mesh.get("contact_tolerance_m")
    if given is not None or contact_spread is not None:
        middle = median if given is None else 1e3 * given
        spread = KNOWN_CONTACT_SPREAD if contact_spread is None else contact_spread
        unknowns["contact_tolerance_mm"] = lognormal(middle, spread)
    # what is wrong with the mesh is said of its middle tolerance
    shape.contact_polygon(unknowns["contact_tolerance_mm"](0.5) / 1e3)
    open_ones = {
        name: unknown for name, unknown in unknowns.items() if name not in exact
    }
    arrangements = draw_arrangements(shape, open_ones, ARRANGEMENTS, 1, exact).table
    arrangements["least_deg"] = [
        _least_angle_deg(shape, way) for way in arrangements.to_dict("records")
    ]
    contact = {"median": two(median), "spread": 50 if accuracy is None else 30}
    assumed = [
        assume(source, source, **(contact if source == "contact" else {}))
        for source in map(SOURCE_OF.__getitem__, open_ones)
        if source != "contact" or given is None
    ]
    # in space it turns about any edge, and its direction is no source
    upright = arrangements[arrangements["least_deg"] >= LEAST_ANGLE_DEG]
    carries = [name for name in open_ones if name != "direction_deg"]
    space = _ordered(shape, upright, carries, "least_deg") if len(upright) else None
    return replace(
        _ordered(shape, arrangements, list(open_ones), "alpha_deg"), space=space
    ), assumed


def _ordered(
    shape: Shape, arrangements: pd.DataFrame, names: list[str], order: str
) -> Scan:
    """A scan whose ways to stand are sorted by a column, with the part of each unknown in it.

    Parameters
    ----------
    shape : of the scan
    arrangements : a row a way to stand, with the columns ``names`` and ``order``
    names : of the unknowns that were drawn
    order : column that the ways are sorted by
    """
    ordered = arrangements.sort_values(order, kind="stable", ignore_index=True)
    return Scan(shape, ordered, _parts(ordered, names, order), order)


def _least_angle_deg(shape: Shape, way: Mapping[Any, Any]) -> float:
    """Least angle of all directions at which a way to stand balances [degrees]; negative where it cannot."""
    reach = edge_distances(
        shape.contact_polygon(way["contact_tolerance_mm"] / 1e3)
    ).min()
    return math.degrees(
        math.atan2(reach - way["edge_retreat_mm"] / 1e3, shape.cg_height)
    )


def _parts(
    arrangements: pd.DataFrame, names: list[str], order: str
) -> dict[str, float]:
    """Part of each unknown in the variance of the order: that of its means in bins of equally many ways."""
    values = special.ndtri(
        (arrangements[order].rank(method="first").to_numpy() - 0.5) / len(arrangements)
    )
    found = {}
    for name in names:
        bins = (
            arrangements[name].rank(method="first", pct=True).to_numpy()
            * _BINS
            * 0.999999
        ).astype(int)
        means = np.array([values[bins == k].mean() for k in range(_BINS)])
        # means of few ways differ by chance too
        found[SOURCE_OF[name]] = max(
            0.0, float(means.var() - values.var() * _BINS / len(values))
        )
    total = sum(found.values())
    return {name: value / total for name, value in found.items() if value > 0}
