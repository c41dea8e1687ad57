"""The engine in space behind the contract of engines."""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockfrag.engines.contract import Case, Cases, Request, Support, Wish, by_wishes
from rockfrag.engines.spatial.body import kernel_body, later_peaks, perturbed, standing
from rockfrag.engines.spatial.outcome import AFTER, SpatialOutcome, history_table, run_case
from rockfrag.errors import InputError
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.records.motion import GroundMotion
from rockfrag.system.blocks import Block, as_system
from rockfrag.system.system import System
from rockfrag.units import GRAVITY

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True)
class SpatialResponse:
    """Outcome and history of one analysis in space.

    The history has a row per sample: ``time_s``; ``x_m``, ``y_m``, ``z_m`` of the centre of mass relative to the
    ground; ``tilt_rad`` of the body's axis and ``axis_x``, ``axis_y``, its horizontal components; ``turn_rad``
    about the vertical; ``base_x_m``, ``base_y_m``, the base's point below the centre of mass; ``omega_x_rad_s``
    to ``omega_z_rad_s`` in the body; ``contacts``, the number of closed points, NaN at rest.
    """

    outcome: SpatialOutcome
    history: pd.DataFrame
    # of the base at first, from below the centre of mass, shape (n, 2) [m]
    outline: NDArray[np.float64]

    @property
    def overturned(self) -> bool:
        """Whether the body fell."""
        return self.outcome.overturned

    def plot(self, title: str = "") -> "Figure":
        """Draw the path of the axis, and the base in the plan."""
        from rockfrag.engines.response_figure import spatial_figure

        return spatial_figure(self.outcome, self.history, self.outline, title)

    @property
    def lost_contact(self) -> float:
        """NaN: a body in space leaves the ground where it has to, so no contact is held shut."""
        return math.nan


class SpatialEngine:
    """One rigid body on a polygon or a circle, contact event by contact event (``docs/space.md``)."""

    name = "space"
    meets = frozenset({Wish.SPACE, Wish.VERTICAL, Wish.FRICTION, Wish.HISTORY})

    def supports(self, system: System, motion: GroundMotion, request: Request) -> Support:
        """Say whether it computes this system under this motion as requested, and if not, why."""
        found = by_wishes(self, system, motion, request)
        if found and system.planar:
            return Support(reason="a planar body moves in its own plane only; give its depth")
        return found

    def run(self, cases: Cases, spread: float = 0.0, seed: int = 0) -> Outcomes:
        """Return the outcomes of cases that it supports; spread and seed are those of :func:`run_in_space`."""
        result = empty_outcomes(cases.names, cases.scales, [self.name])
        g = cases.request.g
        bodies = [kernel_body(system, g) for system in cases.systems]
        tasks = [(i, j) for i in range(len(bodies)) for j in range(len(cases.motions))]

        def run_pair(task: tuple[int, int]) -> None:
            i, j = task
            motion, body, turned = cases.motions[j], bodies[i], 0.0
            if spread > 0:
                rng = np.random.default_rng([seed, i, j])
                system, turned = perturbed(cases.systems[i], spread, rng)
                body = kernel_body(system, g)
            ground, start = motion.accelerations, standing(body, turned)
            later = later_peaks(ground)
            for k, scale in enumerate(cases.scales[j].tolist()):
                found, _ = run_case(body, ground, motion.dt, scale, g=g, peaks=later, start=start)
                least_gravity_ratio = 1.0 + scale * float(ground[:, 2].min()) / g
                _write(result, (i, j, k), found, least_gravity_ratio)

        with ThreadPoolExecutor(cases.threads) as pool:
            list(pool.map(run_pair, tasks))
        return result

    def history(self, case: Case) -> SpatialResponse:
        """Return outcome and history of a case that it supports."""
        g = case.request.g
        body = kernel_body(case.system, g)
        ground = case.motion.accelerations
        samples = len(ground) + math.ceil(AFTER / case.motion.dt) + 2
        found, history = run_case(body, ground, case.motion.dt, case.scale, g=g, samples=samples)
        table = history_table(history, case.motion.dt, float(body["height"]))
        outline = np.array(body["points"][: body["count"], :2])
        return SpatialResponse(found, table, outline)


ENGINE = SpatialEngine()


def _write(
    result: Outcomes, case: tuple[int, int, int], found: SpatialOutcome, least_gravity_ratio: float
) -> None:
    """Write one outcome into those of all."""
    for name in ("overturned", "certain_time", "impacts", "flights", "paradoxes"):
        getattr(result, name)[case] = getattr(found, name)
    result.overturned_body[case] = 1 if found.overturned else 0
    result.several_modes[case] = found.ambiguous
    result.unstable_distance[case] = math.nan
    result.minimum_gravity_ratio[case] = least_gravity_ratio
    for name in ("peak_rotation", "peak_velocity", "turn", "fall_direction", "fell_over"):
        getattr(result, name)[(*case, 0)] = getattr(found, name)
    result.walk[(*case, 0)] = math.hypot(*found.walk)


def run_in_space(
    bodies: Sequence[System | Block],
    motions: Sequence[GroundMotion],
    scales: ArrayLike = (1.0,),
    *,
    spread: float = 0.0,
    seed: int = 0,
    threads: int = 1,
    g: float = GRAVITY,
) -> Outcomes:
    """Say for every body × motion × scale what becomes of it in space.

    The outcomes have shape (systems, motions, scales); ``scales`` has shape (scales,) or (motions, scales).
    ``spread`` is the largest displacement of each vertex of the base over its extent [-], and the largest angle by
    which the body is turned about the vertical [rad], drawn anew from ``seed`` for each motion: an ideal base has
    outcomes that no real one has.
    """
    request = Request(g=g)
    systems = tuple(as_system(body) for body in bodies)
    for system in systems:
        for motion in motions:
            found = ENGINE.supports(system, motion, request)
            if not found:
                missing = " and ".join(sorted(wish.value for wish in found.missing))
                raise InputError(f"in space: {found.reason or missing + ' cannot be had'}.")
    factors = np.broadcast_to(
        np.atleast_2d(np.asarray(scales, dtype=np.float64)), (len(motions), np.shape(scales)[-1])
    )
    return ENGINE.run(Cases(systems, tuple(motions), factors, request, threads), spread, seed)
