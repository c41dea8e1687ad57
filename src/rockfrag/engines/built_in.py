"""The engines that come with the package: what each can meet, and the functions that answer.

These are loaded, and the kernels with them, when one is first called.
"""

import math
from dataclasses import dataclass, replace
from pkgutil import resolve_name
from typing import Any

from rockfrag.engines.contract import Case, Cases, Engine, Request, Support, Wish
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.records.motion import GroundMotion
from rockfrag.system import geometry
from rockfrag.system.body import Polygon
from rockfrag.system.constraints import Tie, Wall
from rockfrag.system.system import System


@dataclass(eq=False)
class BuiltIn(Engine):
    """An engine by its name, what it can meet, and where its ``run`` and ``history`` stand."""

    name: str
    meets: frozenset[Wish]
    runs: str = ""  # function of cases
    tells: str = ""  # function of one case, of an engine that meets Wish.HISTORY

    def run(self, cases: Cases) -> Outcomes:
        """Return the outcomes of cases that it supports."""
        found: Outcomes = resolve_name(self.runs)(cases)
        return found

    def history(self, case: Case) -> Any:
        """Return the response of a case that it supports."""
        return resolve_name(self.tells)(case)


_REASONS = {
    geometry.BESIDE: "the upper body does not stand on the lower one",
    geometry.OFF_CONTACT: "the upper body's centre of gravity is not above its contact",
    geometry.TILTED_OFF: "a centre of gravity is not above its base as the bodies stand",
    geometry.REACHES_GROUND: "the upper body reaches so far beyond the lower one that it could touch the ground",
}


class PureRocking(BuiltIn):
    """One or two planar bodies that rock and never slide; the lower one is as wide above as below."""

    def supports(
        self, system: System, motion: GroundMotion, request: Request
    ) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        found = super().supports(system, motion, request)
        if not found or system.count != 2:
            return found
        lower = system.in_plane().bodies[0]
        if lower.face != lower.base:
            return Support(reason="the lower body's face is not as wide as its base")
        return Support(
            reason=_REASONS.get(geometry.failed_stability_check(system.pile), "")
        )


class PlanarEngine(BuiltIn):
    """Planar bodies with all contact events, and what holds them in their plane (``docs/contact.md``)."""

    def supports(
        self, system: System, motion: GroundMotion, request: Request
    ) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        found = super().supports(system, motion, request)
        if not found:
            return found
        for constraint in system.constraints:
            if isinstance(constraint, Wall) and constraint.side == 0:
                return Support(reason="a wall stands askew to the plane of motion")
            if isinstance(constraint, Tie) and (
                constraint.point[1] != constraint.anchor[1]
            ):
                return Support(reason="a tie leads out of the plane of motion")
        return found


class SpatialEngine(BuiltIn):
    """One rigid body on a polygon or a circle, contact event by contact event (``docs/space.md``)."""

    def supports(
        self, system: System, motion: GroundMotion, request: Request
    ) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        found = super().supports(system, motion, request)
        if any(contact.tilt for contact in system.contacts):
            # a planar body may lean under one component; one in space may not
            found = replace(found, missing=found.missing | {Wish.TILT})
        if found and system.planar:
            return Support(
                reason="a planar body moves in its own plane only; give its depth"
            )
        return _beside_walls(system) if found else found


def _beside_walls(system: System) -> Support:
    """Say whether the walls beside a body in space are such that it may meet: upright faces, and corners."""
    walls = [each for each in system.constraints if isinstance(each, Wall)]
    if any(wall.height < math.inf for wall in walls):
        return Support(
            reason="a kerb is met in a plane only; leave out the depth or the second component"
        )
    outlines = system.bodies[0].base, system.bodies[0].face
    if walls and not all(isinstance(outline, Polygon) for outline in outlines):
        return Support(
            reason="beside a wall in space stand bodies with corners only, with a base and a face"
        )
    return Support()


_STANDING = frozenset({Wish.VERTICAL, Wish.RESTITUTION})

LONE_BLOCKS = PureRocking(
    "lanes of lone blocks",
    _STANDING,
    "rockfrag.engines.pure_rocking.ensembles:run_blocks",
)
"""Lone bodies, from rest: 64 lanes side by side (``kernels.lanes.block``)."""

TWO_BLOCKS = PureRocking(
    "lanes of two blocks",
    _STANDING | {Wish.TWO_BODIES},
    "rockfrag.engines.pure_rocking.ensembles:run_stacks",
)
"""Two bodies on each other, from rest: lanes of stacks side by side (``kernels.lanes.stack_case``)."""

SINGLE = PureRocking(
    "single histories",
    _STANDING | {Wish.TWO_BODIES, Wish.START, Wish.LINEAR, Wish.FORCES, Wish.HISTORY},
    "rockfrag.engines.pure_rocking.histories:run",
    "rockfrag.engines.pure_rocking.histories:history",
)
"""One or two bodies, case by case (``kernels.single``)."""

STEPPED = PureRocking(
    "jumps of the velocity",
    _STANDING | {Wish.START, Wish.FORCES, Wish.HISTORY, Wish.STEPS},
    "rockfrag.engines.pure_rocking.velocity_steps:run",
    "rockfrag.engines.pure_rocking.velocity_steps:history",
)
"""One body on a base whose velocity jumps, by single histories between the jumps."""

PLANAR = PlanarEngine(
    "planar contact",
    _STANDING
    | {Wish.TWO_BODIES, Wish.MANY_BODIES, Wish.FRICTION, Wish.START, Wish.HISTORY}
    | {Wish.PLACE},
    "rockfrag.engines.planar.engine:run",
    "rockfrag.engines.planar.engine:history",
)
"""Planar bodies that stick, slide, rock, fly and land (``docs/contact.md``)."""

SPATIAL = SpatialEngine(
    "space",
    frozenset(
        {
            Wish.SPACE,
            Wish.VERTICAL,
            Wish.FRICTION,
            Wish.HISTORY,
            Wish.TIE,
            Wish.BOND,
            Wish.WALL,
            Wish.SPREAD,
        }
    ),
    "rockfrag.engines.spatial.engine:run",
    "rockfrag.engines.spatial.engine:history",
)
"""One body in space."""

BUILT_IN = (LONE_BLOCKS, TWO_BLOCKS, SINGLE, STEPPED, PLANAR, SPATIAL)
"""In the order in which they are asked."""
