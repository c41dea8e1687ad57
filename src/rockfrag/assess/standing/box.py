"""An object on a rectangular base of which both sides are known: it rocks, turns and walks in space.

In: settings of a request. Out: an object (:mod:`rockfrag.assess.standing.contract`), sizes in m and kg. Docs:
``docs/assess.md``, "Rectangular bases in space".
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from rockfrag.assess.assumed import Moved, assume
from rockfrag.assess.core import bodies
from rockfrag.assess.standing.changes import row_of
from rockfrag.assess.standing.contract import Foundation, Standing
from rockfrag.assess.standing.dimensions import (
    conserves_momentum,
    on_foundation,
    sizes_of,
)
from rockfrag.assess.standing.planar import Planar
from rockfrag.system.blocks import Block, Body
from rockfrag.system.body import checked_tensor
from rockfrag.system.system import System, turned_about_vertical

# To both sides of how it faces the shaking, where nobody said it [degrees]
ASIDE = 45.0


@dataclass(frozen=True)
class Box(Standing):
    """An object on a rectangular base.

    Attributes
    ----------
    depth : side of the base across the plane [m]
    facing_deg : of that plane, from first to second component of records [degrees]
    faces_anywhere : whether nobody said how it faces the shaking, which counts
    """

    depth: float = 0.0
    facing_deg: float = 0.0
    faces_anywhere: bool = False

    idle_in_plane = frozenset({"facing"})
    in_space_by = "its depth"

    @classmethod
    def takes(cls, settings: Mapping[str, Any]) -> bool:
        """Take what has a width and a depth."""
        return "width_m" in settings and "depth_m" in settings

    @classmethod
    def of(cls, settings: Mapping[str, Any], folder: Path, under: Foundation) -> Self:
        """Make the object of its sizes."""
        sizes = sizes_of(settings)
        first = (assume("box_base"), *conserves_momentum(settings), *sizes.assumed)
        return cls(
            sizes.block,
            sizes.plane,
            on_foundation(under, sizes.block, first, sizes.quality_flags),
            base_spread=float(settings.get("base_spread", 0.0)),
            depth=sizes.depth,
            facing_deg=sizes.facing_deg,
            faces_anywhere="facing_deg" not in settings,
        )

    def variants(self) -> list[Moved[Self]]:
        """The usual ones, and other directions where nobody said how it faces."""
        found = super().variants()
        if self.faces_anywhere:
            lower = replace(self, facing_deg=self.facing_deg - ASIDE)
            upper = replace(self, facing_deg=self.facing_deg + ASIDE)
            found.append(Moved("facing", 0.0, lower, upper))
        return found

    def stretched(
        self, width: float = 1.0, height: float = 1.0, mass: float = 1.0
    ) -> Self:
        """Move all edges, those of the other side too."""
        return replace(super().stretched(width, height, mass), depth=self.depth * width)

    @property
    def in_space(self) -> bool:
        """In space, unless its restitution was measured, its impacts are changed or a pad is to be tried."""
        plain = self.under.restitution is None and self.restitution_factor == 1.0
        return plain and self.under.pad_friction is None

    @property
    def matters_in_space(self) -> tuple[str, ...]:
        """How it faces the shaking too, if somebody said it."""
        facing = () if self.faces_anywhere else ("facing_deg",)
        return (*facing, *super().matters_in_space)

    def in_plane(self) -> Planar:
        """The object as it rocks across its narrower side."""
        return Planar(self.block, self.plane, self.under, self.restitution_factor)

    def solid(self, body: Body) -> System | None:
        """The object on its rectangular base, or one with what it is fixed to, whose base is square or as deep."""
        if not self.in_space:
            return None
        return turned_about_vertical(
            self._box(body.blocks[-1]).system(), self.facing_deg
        )

    def _box(self, top: Block) -> Block:
        """A block that rocks as this box does, in space, with the pedestal to which it may be fixed."""
        moments = np.zeros(4)
        bodies.tell_box(row_of(top), row_of(self.block, self.depth), moments)
        *tensor, depth = moments.tolist()
        return replace(top, depth=depth, inertia=checked_tensor(np.diag(tensor)))
