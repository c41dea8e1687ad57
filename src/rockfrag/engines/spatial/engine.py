"""The engine in space: many outcomes, or one analysis with its history (``docs/space.md``).

In: :class:`rockfrag.engines.contract.Cases` of single bodies with a depth. Out:
:class:`rockfrag.outcomes.Outcomes`, or of one case a :class:`SpatialResponse`.
"""

import math
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.arrays import Floats
from rockfrag.base.units import GRAVITY
from rockfrag.engines.built_in import SPATIAL as ENGINE
from rockfrag.engines.compile.jit import compiling_alone
from rockfrag.engines.contract import Case, Cases, Request
from rockfrag.engines.spatial import _integrate as kernel
from rockfrag.engines.spatial import _limits as limits
from rockfrag.engines.spatial import _outcome as outcome
from rockfrag.engines.spatial._body import (
    ATTITUDE,
    BOND,
    FRICTION,
    HOLDERS,
    PLACE,
    SPIN,
)
from rockfrag.engines.spatial._case import CASE
from rockfrag.engines.spatial.body import (
    acting,
    kernel_body,
    perturbed,
    standing,
)
from rockfrag.outcomes.outcomes import Outcomes, columns, empty_outcomes
from rockfrag.outcomes.response import constraint_table
from rockfrag.system.system import System

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# largest error of a step: position [m], attitude [-], velocities [m/s, rad/s]
TOLERANCE = 1e-8
# energy over rest, as a part of what a fall takes, at which a body rests [-]
CUT_OFF = 1e-6
AFTER = 30.0  # time after the motion at which an analysis ends at the latest [s]


@dataclass(frozen=True)
class SpatialOutcome:
    """What became of a body in space."""

    overturned: bool  # whether it fell
    certain_time: float  # instant from which the fall was certain [s]; NaN without one
    fall_direction: float  # from x towards y [rad]; NaN without a fall
    # on the ground: "edge 1-2", "vertex 2", "rim", or "flight" without any; empty without a fall
    fell_over: str
    # largest tilt over that of unstable balance [-]; infinite if it fell
    peak_rotation: float
    peak_tilt: float  # largest tilt until the outcome was known [rad]
    peak_velocity: float  # largest angular velocity until then [rad/s]
    # (x, y) at the end of the base's point below the centre of mass [m]
    walk: tuple[float, float]
    turn: float  # rotation about the vertical at the end [rad], several turns counted
    impacts: int  # number of impacts
    slidings: int  # number of contacts that began to slide
    flights: int  # number of flights
    ambiguous: int  # impacts and changes of mode with more than one admissible outcome
    # impacts and changes without one, and jams: contacts that no finite force holds
    paradoxes: int
    dissipated: tuple[float, float]  # energy lost in impacts, and by friction [J/kg]
    residual: float  # what the balance of energy does not close by [J/kg]
    # energy that events of contact added, by rounding or as a rim leaves rest tilted [J/kg]
    gained: float
    # largest impulse of an impact along the ground beyond the friction of that across it, for a unit of mass [m/s]
    beyond_friction: float
    leaning: bool  # whether it rests beyond its balance, against a wall or in a tie
    # of what holds it, for a unit of mass: hits, largest impulse [m/s], largest force [m/s²] and time of breaking
    # [s], shape (HOLDERS, OF_HOLDER)
    borne: Floats = field(compare=False, repr=False)


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
    # a row per wall, tie and bond, as those of outcomes; None where nothing holds it
    constraints: pd.DataFrame | None = field(default=None, repr=False)

    @property
    def overturned(self) -> bool:
        """Whether the body fell."""
        return self.outcome.overturned

    def plot(self, title: str = "") -> "Figure":
        """Draw the path of the axis, and the base in the plan."""
        from rockfrag.engines.spatial.response_figure import spatial_figure

        return spatial_figure(self.outcome, self.history, self.outline, title)

    def samples(self) -> dict[str, NDArray[Any]]:
        """Return the columns of a row per sample and body, here one body: those of the history."""
        columns = {
            str(name): values.to_numpy() for name, values in self.history.items()
        }
        return columns | {"body": np.ones(len(self.history), np.int64)}

    @property
    def lost_contact(self) -> float:
        """NaN: a body in space leaves the ground where it has to, so no contact is held shut."""
        return math.nan


def run(cases: Cases) -> Outcomes:
    """Return the outcomes of cases that it supports.

    Of a base that is spread each vertex is moved, and the body turned, anew for each system and motion: an ideal
    base has outcomes that no real one has.

    Parameters
    ----------
    cases : systems of one body each, motions with all components, scales of each motion

    Returns
    -------
    Outcomes, shape (systems, motions, scales), in which the quantities of bodies have one body.
    """
    result = empty_outcomes(
        cases.names, cases.scales, [ENGINE.name], holding=cases.holding
    )
    g = cases.request.g
    standing_bodies = [_as_given(system, g) for system in cases.systems]
    systems, motions = range(len(cases.systems)), range(len(cases.motions))
    tasks = [(i, j) for i in systems for j in motions]

    def run_pair(task: tuple[int, int]) -> None:
        """Integrate a system under a motion at all its scales into the outcomes."""
        i, j = task
        motion, (body, start) = cases.motions[j], standing_bodies[i]
        if cases.request.spread > 0:
            body, start = _spread(cases.systems[i], cases.request, task)
        ground = motion.accelerations
        # a copy: an array that may not be written would be a type of its own to the kernel
        scales = np.array(cases.scales[j])
        found = run_scales(body, ground, motion.dt, scales, g=g, start=start)
        result.minimum_gravity_ratio[i, j] = (
            1.0 + scales * float(ground[:, 2].min()) / g
        )
        _write(result, (i, j), body, found)
        _write_holding(result, (i, j), cases.systems[i], _borne(found.outs))

    with ThreadPoolExecutor(cases.threads) as pool:
        list(pool.map(run_pair, tasks))
    return result


def _as_given(system: System, g: float) -> tuple[np.void, Floats]:
    """Record ``BODY`` of the body of a system for the kernel, and the state in which it stands, shape (SIZE,)."""
    body = kernel_body(system, g)
    return body, standing(body)


def _spread(
    system: System, request: Request, place: tuple[int, int]
) -> tuple[np.void, Floats]:
    """Record and state as :func:`_as_given`, with vertices moved and the body turned.

    The request has the spread and a seed; ``place``, of the system and the motion in a grid, numbers the draw.
    """
    rng = np.random.default_rng([request.seed, *place])
    moved, turned = perturbed(system, request.spread, rng)
    body = kernel_body(moved, request.g)
    return body, standing(body, turned)


def history(case: Case) -> SpatialResponse:
    """Return outcome and history of a case that it supports; a spread is that of the first case of a grid.

    Parameters
    ----------
    case : a system of one body, a motion with all components, a scale

    Returns
    -------
    Outcome, a table of samples until 30 s after the motion at most, and the outline of the base.
    """
    g = case.request.g
    body, start = _as_given(case.system, g)
    if case.request.spread > 0:
        body, start = _spread(case.system, case.request, (0, 0))
    ground = case.motion.accelerations
    samples = len(ground) + math.ceil(AFTER / case.motion.dt) + 2
    found, history = run_case(
        body,
        ground,
        case.motion.dt,
        case.scale,
        g=g,
        samples=samples,
        start=start,
    )
    table = history_table(history, case.motion.dt, float(body["height"]))
    outline = np.array(body["points"][: body["count"], :2])
    return SpatialResponse(found, table, outline, _constraints(case.system, found))


def run_case(
    body: np.void,
    acceleration: Floats,
    dt: float,
    scale: float = 1.0,
    *,
    g: float = GRAVITY,
    samples: int = 0,
    tolerance: float = TOLERANCE,
    start: Floats | None = None,
) -> tuple[SpatialOutcome, Floats]:
    """Integrate one analysis of a body.

    Parameters
    ----------
    body : record ``BODY``
    acceleration : of the ground (x, y, up), shape (n, 3) [m/s²]
    dt : interval of its samples [s]
    scale : that it is multiplied by [-]
    g : acceleration of gravity [m/s²]
    samples : of the history at most
    tolerance : error of a step [m, -, m/s, rad/s]
    start : state to begin with, shape (SIZE,); None: standing over the origin

    Returns
    -------
    The outcome, and the history, shape (m, COLUMNS): m is ``samples`` at most.
    """
    history = np.full((samples, outcome.COLUMNS), math.nan)
    found = run_scales(
        body,
        acceleration,
        dt,
        np.array([scale]),
        g=g,
        tolerance=tolerance,
        start=start,
        history=history,
    )
    kept = ~np.isnan(history[:, 0])
    single = _outcome(body, found.outs[0], found.counts[0], found.ends[0])
    return single, history[kept]


class Found(NamedTuple):
    """What the kernel leaves of a body at several scales of a motion."""

    outs: Floats  # outcomes, shape (scales, OUTCOME)
    counts: NDArray[np.int64]  # counters, shape (scales, COUNTERS)
    ends: Floats  # states at the end, shape (scales, SIZE)


def run_scales(
    body: np.void,
    acceleration: Floats,
    dt: float,
    scales: Floats,
    *,
    g: float = GRAVITY,
    tolerance: float = TOLERANCE,
    start: Floats | None = None,
    history: Floats | None = None,
) -> Found:
    """Integrate one analysis a scale, all from the same state; other arguments are those of :func:`run_case`.

    ``scales`` has the shape (scales,) [-]; ``history`` takes the samples of the last one, shape (samples,
    COLUMNS).
    """
    acceleration = np.ascontiguousarray(acceleration)
    peaks = np.empty((len(acceleration), 4))
    begins = standing(body) if start is None else start
    found = Found(
        np.zeros((len(scales), outcome.OUTCOME)),
        np.zeros((len(scales), limits.COUNTERS), np.int64),
        np.tile(begins, (len(scales), 1)),
    )
    rows = np.empty((0, outcome.COLUMNS)) if history is None else history
    extra = math.ceil(AFTER / dt)
    bodies, cases = np.asarray(body).reshape(1), np.zeros(1, CASE)
    with compiling_alone(kernel.integrate_scales):
        kernel.integrate_scales(
            bodies, acceleration, peaks, scales, dt, g, extra, tolerance, CUT_OFF,
            found.ends, rows, found.outs, found.counts, cases,
        )  # fmt: skip
    return found


def _outcome(
    body: np.void, out: Floats, counters: NDArray[np.int64], y: Floats
) -> SpatialOutcome:
    """An outcome by names, from what the kernel left: a row (OUTCOME,), its counters and the last state."""
    fell = bool(out[outcome.FELL])
    return SpatialOutcome(
        overturned=fell,
        certain_time=float(out[outcome.CERTAIN_TIME]),
        fall_direction=float(out[outcome.FALL_AZIMUTH]) if fell else math.nan,
        fell_over=_named(body, out.tolist()) if fell else "",
        peak_rotation=math.inf if fell else float(out[outcome.PEAK_RATIO]),
        peak_tilt=float(out[outcome.PEAK_TILT]),
        peak_velocity=float(out[outcome.PEAK_SPEED]),
        walk=(float(out[outcome.WALK_X]), float(out[outcome.WALK_Y])),
        turn=float(out[outcome.TURN]),
        impacts=int(counters[limits.IMPACTS]),
        slidings=int(counters[limits.SLIDINGS]),
        flights=int(counters[limits.FLIGHTS]),
        ambiguous=int(counters[limits.AMBIGUOUS]),
        paradoxes=int(counters[limits.UNSOLVED] + counters[limits.JAMS]),
        dissipated=(float(out[outcome.LOST]), float(y[FRICTION])),
        residual=float(out[outcome.ENERGY_BALANCE]),
        gained=float(out[outcome.GAINED]),
        beyond_friction=float(out[outcome.BEYOND]),
        leaning=bool(out[outcome.LEANS]),
        borne=_borne(out),
    )


def _named(body: np.void, out: Sequence[float]) -> str:
    """Say over what a body fell: "edge 1-2", "vertex 2", "rim", or "flight" if it did not touch the ground.

    Vertices are numbered from 1, in the order of the base.
    """
    first, second = int(out[outcome.FALL_FIRST]), int(out[outcome.FALL_SECOND])
    if first < 0:
        return "flight"
    if body["rim"] > 0:
        return "rim"
    if second < 0:
        return f"vertex {first + 1}"
    low, high = sorted((first, second))
    return f"edge {low + 1}-{high + 1}"


def history_table(history: Floats, dt: float, height: float) -> pd.DataFrame:
    """Return a history of :func:`run_case` as the table of a :class:`rockfrag.engines.spatial.SpatialResponse`.

    Parameters
    ----------
    history : shape (samples, COLUMNS)
    dt : interval of the samples [s]
    height : of the centre of mass over the base [m]

    Returns
    -------
    A row a sample, columns as the class names them.
    """
    w, x, y, z = history[:, ATTITUDE : ATTITUDE + 4].T
    # the body's z axis in axes of the ground, from the quaternion
    axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    place = history[:, PLACE : PLACE + 3]
    count = history[:, outcome.COUNT]
    closed = np.where(count == outcome.RESTS, math.nan, count)
    return pd.DataFrame(
        {
            "time_s": np.arange(len(history)) * dt,
            **dict(zip(("x_m", "y_m", "z_m"), place.T, strict=True)),
            "tilt_rad": np.arctan2(np.hypot(axis[0], axis[1]), axis[2]),
            "axis_x": axis[0],
            "axis_y": axis[1],
            "turn_rad": history[:, outcome.TURNED],
            "base_x_m": place[:, 0] - height * axis[0],
            "base_y_m": place[:, 1] - height * axis[1],
            **{
                f"omega_{name}_rad_s": history[:, SPIN + k]
                for k, name in enumerate("xyz")
            },
            "contacts": closed,
        }
    )


def _write(
    result: Outcomes, case: tuple[int, int], body: np.void, found: Found
) -> None:
    """Write the outcomes of a body under a motion, at all scales, into those of all.

    ``case`` is the place of the system and the motion in the grid.
    """
    outs, counts = found.outs, found.counts
    fell = outs[:, outcome.FELL] > 0
    result.overturned[case], result.overturned_body[case] = fell, fell
    result.certain_time[case] = outs[:, outcome.CERTAIN_TIME]
    result.impacts[case] = counts[:, limits.IMPACTS]
    result.flights[case] = counts[:, limits.FLIGHTS]
    result.paradoxes[case] = counts[:, limits.UNSOLVED] + counts[:, limits.JAMS]
    result.several_modes[case] = counts[:, limits.AMBIGUOUS]
    result.unstable_distance[case] = math.nan
    result.leaning[case] = outs[:, outcome.LEANS] > 0
    peaks = np.where(fell, math.inf, outs[:, outcome.PEAK_RATIO])
    directions = np.where(fell, outs[:, outcome.FALL_AZIMUTH], math.nan)
    result.peak_rotation[case][:, 0] = peaks
    result.peak_velocity[case][:, 0] = outs[:, outcome.PEAK_SPEED]
    result.turn[case][:, 0] = outs[:, outcome.TURN]
    result.fall_direction[case][:, 0] = directions
    for k, out in enumerate(outs.tolist()):
        result.fell_over[case][k, 0] = _named(body, out) if fell[k] else ""
        result.walk[case][k, 0] = math.hypot(out[outcome.WALK_X], out[outcome.WALK_Y])


def _write_holding(
    result: Outcomes, case: tuple[int, int], system: System, borne: Floats
) -> None:
    """Write what held a body had to bear under a motion, at all scales, into the outcomes of all."""
    if not (system.constraints or system.bonds):
        return
    rows = {row: holder for holder, row in enumerate(acting(system))}
    if system.bonds:
        rows[len(system.constraints)] = BOND
    mass = system.bodies[0].mass
    for row, holder in rows.items():
        hits, impact, force, breaks = borne[:, holder].T
        result.hits[case][:, row] = hits
        result.largest_impulse[case][:, row] = mass * impact
        result.largest_force[case][:, row] = mass * force
        result.breaking_time[case][:, row] = breaks


def _borne(outs: Floats) -> Floats:
    """What holders had to bear, of rows of outcomes of shape (..., OUTCOME): shape (..., HOLDERS, OF_HOLDER)."""
    size = HOLDERS * outcome.OF_HOLDER
    of_holders = outs[..., outcome.HELD : outcome.HELD + size]
    return of_holders.reshape(*outs.shape[:-1], HOLDERS, outcome.OF_HOLDER)


def _constraints(system: System, found: SpatialOutcome) -> pd.DataFrame | None:
    """Table of what held a body, as :class:`rockfrag.outcomes.response.Response` has it; None if nothing does."""
    if not system.holding:
        return None
    result = empty_outcomes(
        [system.names], np.ones((1, 1)), [ENGINE.name], holding=[system.holding]
    )
    _write_holding(result, (0, 0), system, found.borne[np.newaxis])
    values = {
        column.name: getattr(result, column.name)[0, 0, 0]
        for column in columns("constraints")
    }
    return constraint_table(system.holding, values)
