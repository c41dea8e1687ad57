"""Wax, putty, mortar and pins: what keeps a contact shut until it breaks (``docs/holding.md``)."""

import math
from dataclasses import dataclass, replace
from typing import Any

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import number_from_zero, positive_number
from rockfrag.system.body import Circle, Interval, Outline


@dataclass(frozen=True)
class Bond:
    """Wax, putty, mortar or pins in a contact: whole, it stays shut whatever the sign of its force.

    It is one of pads at ± ``spread``, each with its part of the tensile capacity.  Of several pads in space there
    are four, at (± x, ± y), each of a quarter.  It breaks once and for ever.

    Attributes
    ----------
    tension : tensile capacity of all pads [N]
    shear : force that it bears along the contact beside friction [N]
    spread : half the distance of the pads along x and along y, or one for both [m]
    """

    tension: float
    shear: float
    spread: float | tuple[float, float]

    def __post_init__(self) -> None:
        number_from_zero("Bond: tension", self.tension, "newtons")
        number_from_zero("Bond: shear", self.shear, "newtons")
        spread: Any = self.spread
        pair = tuple(spread) if isinstance(spread, (tuple, list)) else (spread, spread)
        if len(pair) != 2:
            raise InputError(
                f"Bond: spread: expected (x, y) in metres, got {spread!r}."
            )
        for value in pair:
            positive_number("Bond: spread", value, "metres")
        object.__setattr__(self, "spread", pair)

    @property
    def pads(self) -> tuple[float, float]:
        """Half the distance of the pads along x and along y [m]."""
        assert isinstance(self.spread, tuple)
        return self.spread

    def room_under(self, base: Outline) -> float:
        """Factor on the distances of the pads at which they reach the edge of a base [-].

        Below 1 they lie outside.  They lie around the middle of a planar base, in space around its origin.
        """
        x, y = self.pads
        if isinstance(base, Interval):
            return (base.right - base.left) / 2 / x
        each = [(x, y), (-x, y), (-x, -y), (x, -y)]
        if isinstance(base, Circle):
            return min(_room_in_circle(base, pad) for pad in each)
        ends = zip(base.vertices, (*base.vertices[1:], base.vertices[0]), strict=True)
        rooms = [math.inf]
        for (x0, y0), (x1, y1) in ends:
            # outwards across an edge, of an outline that runs anticlockwise
            east, north = y1 - y0, x0 - x1
            away = max(east * pad[0] + north * pad[1] for pad in each)
            rooms.append((east * x0 + north * y0) / away)
        return min(rooms)

    def kept_under(self, base: Outline) -> "Bond":
        """Return the bond, its pads shifted inwards where they lie outside a base."""
        room = self.room_under(base)
        if not 0 < room < 1:
            return self
        x, y = self.pads
        return replace(self, spread=(room * x, room * y))

    @classmethod
    def of_layer(
        cls, width: float, depth: float, strength: float, shear: float
    ) -> "Bond":
        """Return the bond of a whole layer of a tensile strength that breaks where its edge first reaches it.

        Parameters
        ----------
        width, depth : of the layer along x and y [m]
        strength, shear : tensile and shear strength [Pa]

        Returns
        -------
        The bond whose pads, at a sixth of the sides, are overloaded at the same instant: with σ = N/(w d) ±
        6 M/(w² d) ≥ -f_t, N/2 ± 3 M/w ≥ -f_t w d/2 (pads at w/6).
        """
        area = width * depth
        return cls(strength * area, shear * area, (width / 6, depth / 6))


def _room_in_circle(base: Circle, pad: tuple[float, float]) -> float:
    """Factor on the distance of a pad from the origin at which it reaches the edge of a round base [-]."""
    (x, y), (east, north) = pad, base.centre
    square, along = x * x + y * y, x * east + y * north
    inside = base.radius * base.radius - (east * east + north * north)
    if inside < 0:
        return 0.0
    return (along + math.sqrt(along * along + square * inside)) / square
