"""An object on a round base: it rolls on its rim in space and loses nothing.

In: settings of a request. Out: an object (:mod:`rockfrag.assess.standing.contract`), sizes in m and kg. Docs:
``docs/assess.md``, "Round bases".
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from rockfrag.assess.assumed import assume
from rockfrag.assess.core import bodies
from rockfrag.assess.standing.changes import row_of
from rockfrag.assess.standing.contract import Foundation, Standing
from rockfrag.assess.standing.dimensions import on_foundation, sizes_of
from rockfrag.assess.standing.planar import Planar
from rockfrag.assess.texts import Text
from rockfrag.simulation.options import system_of
from rockfrag.system.blocks import Body
from rockfrag.system.body import checked_tensor
from rockfrag.system.system import System

# Restitution of a round base: its rim rolls from edge to edge and loses nothing
ROLLING = 1.0


class Round(Standing):
    """An object on a round base, whose width is its diameter."""

    in_space_text: ClassVar[Text] = Text.ROLLS_IN_SPACE
    from_all_sides: ClassVar[bool] = True
    in_space_by: ClassVar[str] = "its round base"

    @classmethod
    def takes(cls, settings: Mapping[str, Any]) -> bool:
        """Take what is said to be round."""
        return bool(settings.get("round", False))

    @classmethod
    def of(cls, settings: Mapping[str, Any], folder: Path, under: Foundation) -> Self:
        """Make the object of its sizes."""
        sizes = sizes_of(settings)
        first = (assume("round_base"), *sizes.assumed)
        under = on_foundation(under, sizes.block, first, sizes.quality_flags)
        spread = float(settings.get("base_spread", 0.0))
        return cls(sizes.block, sizes.plane, under, base_spread=spread)

    def moves(self) -> dict[str, Callable[[float], Self]]:
        """The usual moves, but for impacts, which a rim has none of."""
        found = super().moves()
        del found["restitution"]
        return found

    def system_of(self, body: Body) -> System:
        """The body in a plane, with the restitution of each contact.

        On its own base the object rolls and loses nothing. Fixed to its pedestal the two are one block, higher
        than the object, which rocks on the pedestal's base.
        """
        system = body.system()
        rolls = body.blocks[-1].height == self.block.height
        usual = self.under.restitution
        *below, top = system.carried
        restitution = [self._ratios(shape, usual) for shape in below]
        restitution.append(self._ratios(top, ROLLING if rolls else usual))
        return system_of(system, restitution=restitution if below else restitution[0])

    @property
    def in_space(self) -> bool:
        """Always in space."""
        return True

    def in_plane(self) -> Planar:
        """The object as it would rock on edges."""
        return Planar(self.block, self.plane, self.under, self.restitution_factor)

    def solid(self, body: Body) -> System | None:
        """The object on its rim; None with what it is fixed to, which stands on another base."""
        top = body.blocks[-1]
        if self.is_whole(top):
            return None
        moments = np.zeros(4)
        bodies.tell_round(row_of(top), moments)
        tensor = checked_tensor(np.diag(moments[:3]))
        return replace(top, round=True, inertia=tensor).system()
