"""How an object stands, which nobody measured: guesses of all of it, from distributions with their sources.

A scan says where the surface is, not which of its points carry, where the object faces or what its impacts take.
A campaign study gives a range for each unknown, and its tests judge the trials that fill the ranges; where there
are no tests, each has a distribution.

In: a scan or sizes [m], ranges of what is unknown, a seed. Out: systems, one a trial. Theory:
``docs/campaigns.md``, ``docs/definitions.md``.
"""

import math
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray
from scipy import special

from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.fragility.model_error import CUT, SCAN
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.ensemble import LightBodies, overturns
from rockfrag.simulation.inputs import checked_threads
from rockfrag.simulation.options import system_of
from rockfrag.system import geometry
from rockfrag.system.blocks import Block, Column
from rockfrag.system.body import Polygon, RigidBody
from rockfrag.system.contact import Contact, Friction
from rockfrag.system.mesh import Shape, edge_distances
from rockfrag.system.system import System

UNKNOWNS = (
    "direction_deg",
    "contact_tolerance_mm",
    "edge_retreat_mm",
    "restitution",
    "friction",
    "size",
)
"""What may be given as a range: direction of shaking from the mesh's x axis, height above the lowest point up
to which points carry, distance by which edges lie further in, and in the plane the ratio of angular velocities in
an impact (values above the one that conserves momentum stand for that); in space, and of blocks on each other, the
coefficient of friction; of a block by hand its size over that given."""

# quantile function of something that nobody measured
Quantile = Callable[[float], float]

BATCH = 50  # motions whose outcomes are in memory at a time


@dataclass(frozen=True)
class Trials:
    """Guesses of what was not measured."""

    # one row a trial: the unknowns, ``left_m`` and ``right_m`` (edge distances from the centre of gravity) and
    # ``alpha_deg`` (the smaller critical angle); of blocks on each other those of the uppermost
    table: pd.DataFrame
    systems: tuple[System, ...]  # what stood on the table in each trial
    # the planar block of each, where both friction and restitution are unknown
    planar: tuple[System, ...] = ()

    __repr__ = short_repr


def uniform(low: float, high: float) -> Quantile:
    """Quantile function of a uniform distribution.

    Parameters
    ----------
    low, high : its ends

    Returns
    -------
    A function of probabilities [-].
    """
    return lambda fraction: low + (high - low) * fraction


def lognormal(median: float, spread: float) -> Quantile:
    """Quantile function by the median and the standard deviation of the logarithm.

    Parameters
    ----------
    median, spread : the median, and the standard deviation of the logarithm [-]

    Returns
    -------
    A function of probabilities [-].
    """
    return lambda fraction: median * math.exp(spread * float(special.ndtri(fraction)))


def even_guesses(
    quantiles: Mapping[str, Quantile], count: int, seed: int
) -> Iterator[dict[str, float]]:
    """Yield guesses that fill distributions evenly (scrambled Sobol points), most evenly by a power of two.

    Parameters
    ----------
    quantiles : quantile function of each unknown
    count, seed : number of guesses, and where the points start

    Returns
    -------
    Values by unknown, a guess after the other.
    """
    # takes half a second to load, and most objects are no scans
    from scipy.stats import qmc

    sobol = qmc.Sobol(len(quantiles), scramble=True, rng=np.random.default_rng(seed))
    for point in sobol.random(count):
        fractions = zip(quantiles.items(), point, strict=True)
        yield {
            name: float(quantile(fraction)) for (name, quantile), fraction in fractions
        }


def sample_trials(
    thing: Shape | Block | Column,
    ranges: Mapping[str, tuple[float, float]],
    count: int,
    seed: int,
) -> Trials:
    """Fill the ranges of the unknowns evenly with trials.

    A shape with ``friction`` is a body in space, beside the planar block if it has ``restitution`` as well; a
    block whose edges were measured has no direction and tolerance; blocks on each other have ``friction`` too.

    Parameters
    ----------
    thing, ranges : the object, and lower and upper end by unknown
    count, seed : number of trials, and where the points start

    Returns
    -------
    The :class:`Trials`.
    """
    quantiles: dict[str, Quantile] = {
        name: uniform(*ranges[name]) for name in UNKNOWNS if name in ranges
    }
    if "contact_tolerance_mm" in ranges:
        low, high = ranges["contact_tolerance_mm"]
        # in equal ratios, as it may be small
        quantiles["contact_tolerance_mm"] = lambda fraction: (
            low * (high / low) ** fraction
        )
    rows, systems, planar = [], [], []
    for guess in even_guesses(quantiles, count, seed):
        try:
            body = body_of(thing, guess)
            systems.append(_standing(thing, body, guess))
        except InputError:
            continue
        if "friction" in guess and "restitution" in guess:
            planar.append(_in_plane(body, guess))
        block = body.blocks[-1]
        left, right = block.b + block.cg_offset, block.b - block.cg_offset
        angle = math.degrees(block.alpha)
        rows.append({**guess, "left_m": left, "right_m": right, "alpha_deg": angle})
    if not rows:
        raise InputError(
            f"unknowns: under none of {count} guesses could the object have stood; widen contact_tolerance_mm "
            "or lower edge_retreat_mm."
        )
    return Trials(pd.DataFrame(rows), tuple(systems), tuple(planar))


def simulate_tests(
    systems: Sequence[System],
    motions: Sequence[Motion | GroundMotion],
    threads: int | None = None,
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Whether a body overturns, and whether any rocks, shape (trials, tests).

    Parameters
    ----------
    systems, motions : a system a trial, and a motion a test
    threads : threads to use; outcomes do not depend on it

    Returns
    -------
    Whether the body overturns, and whether any rocks, shape (trials, tests) each.
    """
    overturned, rocked = [], []
    for first in range(0, len(motions), BATCH):
        batch = motions[first : first + BATCH]
        with warnings.catch_warnings():
            # a guess may be squat where the object is not
            warnings.simplefilter("ignore", LightBodies)
            shaking = [
                each
                if systems[0].planar or isinstance(each, GroundMotion)
                else GroundMotion(each)
                for each in batch
            ]
            result = overturns(systems, shaking, threads=threads)
        overturned.append(result.overturned[:, :, 0])
        rocked.append((result.peak_rotation[:, :, 0] > 0).any(axis=-1))
    return np.hstack(overturned), np.hstack(rocked)


def simulate_in_space(
    systems: Sequence[System],
    motions: Sequence[Motion],
    scales: Sequence[float] = (1.0,),
    threads: int | None = None,
) -> NDArray[np.bool_]:
    """Whether bodies in space overturn under one horizontal component.

    Parameters
    ----------
    systems, motions : a system an arrangement, and a motion a test
    scales : factors on the motions
    threads : threads to use; outcomes do not depend on it

    Returns
    -------
    Whether each overturns, shape (systems, tests, scales).
    """
    shaking = [GroundMotion(motion).with_second() for motion in motions]
    cores = checked_threads(threads)
    return overturns(systems, shaking, scales=scales, threads=cores).overturned


def least_angle_deg(body: RigidBody) -> float:
    """Least critical angle of a body in space on a polygon, towards any side [degrees]."""
    assert isinstance(body.base, Polygon)
    corners = np.array(body.base.vertices) - np.array(body.centre[:2])
    nearest = float(edge_distances(corners).min())
    return math.degrees(math.atan2(nearest, body.centre[2]))


def solids_of(thing: Shape, arrangements: Trials, count: int) -> list[System]:
    """A scanned object in space on the points that carry, which nothing lets slide, in several arrangements.

    Parameters
    ----------
    thing : the object
    arrangements : how it may stand, a row each with direction [degrees], tolerance and retreat [mm]
    count : how many of these are taken, at most

    Returns
    -------
    The systems; those in which it would not have been set up, since it falls too easily towards some side, are
        left out.
    """
    found: list[System] = []
    for guess in arrangements.table.to_dict("records"):
        with suppress(InputError):
            body = _in_space(thing, guess)
            if least_angle_deg(body) >= LEAST_ANGLE_DEG:
                found.append(System((body,), (Contact(),)))
        if len(found) == count:
            break
    return found


def _in_space(shape: Shape, guess: Mapping[Any, Any]) -> RigidBody:
    """Body of a scanned shape in space, on the points that carry it by a guess."""
    tolerance, retreat = guess["contact_tolerance_mm"], guess["edge_retreat_mm"]
    return shape.body(guess["direction_deg"], tolerance / 1e3, retreat / 1e3)


def _in_plane(planar: Block | Column, guess: Mapping[str, float]) -> System:
    """Planar block, or the column that it is on top of, with the restitution of a guess that gains no energy."""
    restitution = possible_restitution(planar.blocks[-1], guess["restitution"])
    return system_of(planar, restitution=restitution)


def _standing(
    thing: Shape | Block | Column, planar: Block | Column, guess: Mapping[str, float]
) -> System:
    """What stands on the table: planar blocks, or the shape in space on the points that carry.

    ``planar``: block or column of the ``guess``, values by unknown.
    """
    if "friction" not in guess:
        return _in_plane(planar, guess)
    if isinstance(thing, Shape):
        # static and kinetic coefficients are the same
        friction = Friction(guess["friction"], guess["friction"])
        return System((_in_space(thing, guess),), (Contact(friction=friction),))
    return system_of(planar, friction=guess["friction"])


OUTER, GATHERED = 0.1, 0.25
"""An end of a range is preferred if its outer tenth holds more than a quarter of the plausible trials: ours."""


_NOTHING_BEYOND = (("edge_retreat_mm", 0.0), ("restitution", 1.0))
"""Unknowns and ends of their ranges beyond which there can be nothing."""


def preferred_edges(
    trials: pd.DataFrame, plausible: Any, ranges: Mapping[str, tuple[float, float]]
) -> dict[str, str]:
    """Ends of the ranges at which plausible trials gather: ``low end`` or ``high end`` by unknown.

    Parameters
    ----------
    trials, plausible : a row a trial, and labels of the plausible rows
    ranges : lower and upper end by unknown

    Returns
    -------
    The end by unknown, of those that have one.
    """
    found = {}
    for name, (low, high) in ranges.items():
        if name == "direction_deg" and high - low >= 360:
            continue
        # by rank, so that where few trials can stand few are expected
        rank = trials[name].rank(pct=True)[plausible]
        for limit, edge, at in (
            (low, "low", rank <= OUTER),
            (high, "high", rank > 1 - OUTER),
        ):
            if at.mean() > GATHERED and (name, limit) not in _NOTHING_BEYOND:
                found[name] = f"{edge} end"
    return found


def body_of(
    thing: Shape | Block | Column, guess: Mapping[str, float]
) -> Block | Column:
    """Planar block of a guess at the unknowns of a shape or block, or blocks on each other.

    Parameters
    ----------
    thing, guess : the object, and a value for each unknown by its name

    Returns
    -------
    The block or column.
    """
    retreat = guess["edge_retreat_mm"] / 1e3
    if isinstance(thing, Shape):
        return thing.block(
            guess["direction_deg"], guess["contact_tolerance_mm"] / 1e3, retreat
        )
    if "size" in guess:
        (block,) = thing.blocks
        return _of_size(block, guess["size"]).narrowed(retreat)
    return thing.narrowed(retreat)


def _of_size(block: Block, factor: float) -> Block:
    """A planar block with all its lengths times a factor [-], of the same material."""
    assert isinstance(block.cg_height, float) and isinstance(block.inertia, float)
    return Block(
        factor * block.width,
        factor * block.height,
        factor**3 * block.mass,
        factor**5 * block.inertia,
        cg_height=factor * block.cg_height,
        cg_offset=factor * block.cg_offset,
    )


def possible_restitution(block: Block, restitution: float) -> float | None:
    """Return a restitution [-] that gains no energy: as given, or None, which conserves momentum, where it would.

    Parameters
    ----------
    block : whose impacts they are
    restitution : ratio of angular velocities in an impact
    """
    largest = min(
        geometry.largest_restitution(block.shape, pivot) for pivot in (+1, -1)
    )
    return restitution if restitution < largest else None


SCAN_ACCURACY_MM = 0.5
"""Standard deviation of the height of a scanned point where none is stated [mm], of ours."""

LEAST_ANGLE_DEG = 2.0
"""Critical angle below which an object is not set up to stand free [degrees]: of ours; tan 2° is 0.035 g, which a
floor out of level and a push reach."""


def unknowns_of(
    kind: str, scan_accuracy_mm: float | None = None
) -> dict[str, Quantile]:
    """Assumed distributions of the unmeasured properties of a ``cut block`` or a ``scan``.

    Parameters
    ----------
    kind, scan_accuracy_mm : kind of the body, and accuracy of its scan [mm]

    Returns
    -------
    Quantile functions by unknown.
    """
    if kind == CUT:
        return {
            # edges of cut stone are broken by a millimetre or two
            "edge_retreat_mm": uniform(0.0, 2.0),
            # about Housner (1963)
            "restitution_ratio": lambda fraction: (
                1 + 0.05 * float(special.ndtri(fraction))
            ),
        }
    spread = 0.5 if scan_accuracy_mm is None else 0.3
    # two standard deviations of a scanned height are what noise lowers the lowest of many points by
    median = 2 * (scan_accuracy_mm or SCAN_ACCURACY_MM)
    return {
        "direction_deg": uniform(0.0, 360.0),
        "contact_tolerance_mm": lognormal(median, spread),
        # natural and worn edges are round
        "edge_retreat_mm": uniform(0.0, 10.0),
        # a body on few points takes more than momentum; 0.6 to 0.98 were plausible for a granite rock
        "restitution_ratio": uniform(0.7, 1.0),
    }


def draw_arrangements(
    thing: Shape | Block,
    unknowns: Mapping[str, Quantile],
    count: int,
    seed: int,
    known: Mapping[str, float] | None = None,
) -> Trials:
    """Arrangements in which an object may stand, drawn evenly over the distributions (scrambled Sobol points).

    Ways in which it would not have been set up (:data:`LEAST_ANGLE_DEG`) are left out. ``thing`` is a shape, or
    the planar block of a cut one; a power of two fills the distributions most evenly. ``known`` is what was
    measured, by the name of the unknown; restitution conserves momentum if it is in neither.

    Parameters
    ----------
    thing, unknowns : the object, and quantile functions by unknown
    count, seed : number of arrangements, and where the points start
    known : measured values by unknown

    Returns
    -------
    The :class:`Trials`.
    """
    rows, systems = [], []
    for guess in even_guesses(unknowns, count, seed):
        arrangement = dict(known or {}) | guess
        try:
            block = body_of(thing, arrangement).blocks[-1]
        except InputError:
            continue
        angle = math.degrees(block.alpha)
        if angle < LEAST_ANGLE_DEG:
            continue
        momentum = min(block.momentum_restitution(+1), block.momentum_restitution(-1))
        rows.append(arrangement | {"width_m": block.width, "alpha_deg": angle})
        # over that which conserves momentum
        ratio = possible_restitution(
            block, arrangement.get("restitution_ratio", 1.0) * momentum
        )
        systems.append(system_of(block, restitution=ratio))
    if not rows:
        raise InputError(
            f"under none of {count} guesses of what was not measured could the object stand at "
            f"{LEAST_ANGLE_DEG:g}° or more; check that it stands as its mesh does, and its unit."
        )
    return Trials(pd.DataFrame(rows), tuple(systems))


def kind_of(thing: Shape | Block) -> str:
    """Kind of a body: scanned, or cut to measured edges.

    Parameters
    ----------
    thing : the object

    Returns
    -------
    ``scan`` or ``cut block`` (:mod:`rockfrag.fragility.model_error`).
    """
    return SCAN if isinstance(thing, Shape) else CUT
