"""P/NP where the surfaces are as rough as one likes: over a grid of friction at the ground and at the interface.

A response in which an interface never reaches its limit of friction is the response at every higher
coefficient of that interface too.  So the smallest coefficients are tried first, and most of the grid follows.
"""

import math
from collections.abc import Hashable, Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.base.arrays import Flags, Floats
from rockfrag.effects.cluster_means import mean_effects
from rockfrag.engines.contract import Cases, Request
from rockfrag.engines.planar.engine import contact_outcomes
from rockfrag.motions.processing import factors_to_pga
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.simulation.options import system_of
from rockfrag.system.blocks import Body, Stack
from rockfrag.system.system import uplift_ratios
from rockfrag_thesis.sensitivity_analysis.simulated import motion_columns


def friction_ratios(
    stacks: Mapping[str, Stack],
    motions: Sequence[Motion],
    levels_g: Floats,
    *,
    ground: Sequence[float],
    interface: Sequence[float],
    threads: int = 1,
) -> pd.DataFrame:
    """Ratio P/NP of every object and motion at every pair of coefficients of friction.

    Stacks are each object on its pedestal, by the object's name; alone it stands on the ground. ``levels_g`` are
    climbed until the first overturning [g]. Coefficients are of the ``ground`` and of the ``interface`` of
    pedestal and object [-]; infinite ones are added.

    Returns one row per object, motion and pair: ``object``, ``earthquake``, ``floor``, ``motion``, ``ground``,
    ``interface``, ``p_g``, ``np_g`` (largest amplitudes survived before the first overturning [g], NaN where
    nothing or everything was), ``ratio``, and ``resolution`` (half-width to which its logarithm is known).
    """
    below = sorted({*map(float, ground), math.inf})
    between = sorted({*map(float, interface), math.inf})
    pairs = [(first, two) for first in below for two in between]
    step = float(np.log(levels_g[1] / levels_g[0])) if len(levels_g) > 1 else 0.0
    tables = []
    for name, stack in stacks.items():
        alone = survived_amplitudes(
            stack.upper, [(mu,) for mu in below], motions, levels_g, threads
        )
        placed = survived_amplitudes(stack, pairs, motions, levels_g, threads)
        for (pair, two), with_pedestal in zip(pairs, placed, strict=True):
            without = alone[below.index(pair)]
            tables.append(
                pd.DataFrame(
                    {
                        "object": name,
                        **motion_columns(motions),
                        "ground": pair,
                        "interface": two,
                        "p_g": with_pedestal,
                        "np_g": without,
                        "ratio": with_pedestal / without,
                    }
                )
            )
    return pd.concat(tables, ignore_index=True).assign(resolution=step)


def friction_effects(ratios: pd.DataFrame, floors: Mapping[str, int]) -> pd.DataFrame:
    """Mean ratio at every pair of coefficients with its interval over earthquakes, by place and object.

    ``floors`` has the level of each floor by its name; 0 is the ground.

    Returns one row per ``ground``, ``interface``, ``place`` ("ground", "above", or a floor) and ``object`` ("all"
    or one): ``ratio``, ``lower``, ``upper``, ``pairs``, ``earthquakes``, ``left_out`` (pairs that have no ratio,
    because with or without the pedestal nothing fell), ``p_survives``, ``np_survives`` (pairs in which nothing
    fell).
    """
    level = ratios["floor"].map(floors).fillna(0)
    places = {"ground": level == 0, "above": level > 0}
    places |= {
        floor: ratios["floor"] == floor for floor in floors if floor not in places
    }
    work = ratios.assign(d=np.log(ratios["ratio"]))
    parts: dict[tuple[Hashable, ...], pd.DataFrame] = {}
    for (ground, interface), here in work.groupby(["ground", "interface"]):
        for place, inside in places.items():
            for thing in ("all", *ratios["object"].unique()):
                part = here[
                    inside[here.index] & ((thing == "all") | (here["object"] == thing))
                ]
                if len(part):
                    parts[ground, interface, place, thing] = part
    # all at once: a grid of some hundred means takes longer to group than to compute
    known = [
        part.dropna(subset="ratio").assign(scope=k)
        for k, part in enumerate(parts.values())
    ]
    found = mean_effects(pd.concat(known), "scope") if known else {}
    rows = []
    for k, (keys, part) in enumerate(parts.items()):
        mean = found.get(k)
        rows.append(
            {
                **dict(
                    zip(("ground", "interface", "place", "object"), keys, strict=True)
                ),
                "ratio": mean.ratio if mean else math.nan,
                "lower": mean.ratio_lower if mean else math.nan,
                "upper": mean.ratio_upper if mean else math.nan,
                "pairs": len(known[k]),
                "earthquakes": mean.units if mean else 0,
                "left_out": len(part) - len(known[k]),
                "p_survives": int(part["p_g"].isna().sum()),
                "np_survives": int(part["np_g"].isna().sum()),
            }
        )
    return pd.DataFrame(rows)


def survived_amplitudes(
    body: Body,
    frictions: Sequence[tuple[float, ...]],
    motions: Sequence[Motion],
    levels_g: Floats,
    threads: int = 1,
) -> Floats:
    """Largest amplitude [g] survived before the first overturning, climbing a series of levels from rest.

    ``frictions`` has the coefficients of the interfaces, the ground first. Shape (frictions, motions); NaN where
    nothing or everything was survived.
    """
    mu = np.array([(*friction, math.inf)[:2] for friction in frictions])
    # coefficients [q] at which a response of [p] holds: any higher one, or the same if it slid
    higher = mu[np.newaxis] >= mu[:, np.newaxis]
    same = mu[np.newaxis] == mu[:, np.newaxis]
    dominates: Flags = np.all(higher, axis=2)
    scales = np.array([factors_to_pga(motion, levels_g) for motion in motions])
    stands = np.array([not _never_turns(body, friction) for friction in frictions])
    alive = np.repeat(stands[:, np.newaxis], len(motions), axis=1)
    first = np.full(alive.shape, len(levels_g))
    for level in range(len(levels_g)):
        open_ = alive.copy()
        while open_.any():
            chosen = _least(open_, dominates)
            found = _outcomes(
                body,
                frictions,
                motions,
                scales[:, [level]],
                chosen=chosen,
                threads=threads,
            )
            for p, m in np.argwhere(chosen):
                slid = found[p, m]["slid"][: mu.shape[1]] > 0
                holds = np.where(slid, same[p], higher[p]).all(axis=1) & open_[:, m]
                if found[p, m]["overturned_body"]:
                    first[holds, m] = level
                    alive[holds, m] = False
                open_[holds, m] = False
        if not alive.any():
            break
    known = (first > 0) & (first < len(levels_g))
    return np.where(known, levels_g[np.maximum(first - 1, 0)], np.nan)


def _least(open_: Flags, higher: Flags) -> Flags:
    """Open pairs that no other open pair of the same motion is below, shape (pairs, motions)."""
    below = higher & ~np.eye(len(higher), dtype=bool)
    chosen: Flags = open_ & ~((below.T.astype(int) @ open_.astype(int)) > 0)
    return chosen


def _outcomes(
    body: Body,
    frictions: Sequence[tuple[float, ...]],
    motions: Sequence[Motion],
    scales: Floats,
    *,
    chosen: Flags,
    threads: int,
) -> NDArray[np.void]:
    """Outcomes of the chosen frictions × motions; the others are zero."""
    rows = np.flatnonzero(chosen.any(axis=1))
    columns = np.flatnonzero(chosen.any(axis=0))
    systems = tuple(
        system_of(
            body, dict(zip(("ground", "interface"), frictions[row], strict=False))
        )
        for row in rows.tolist()
    )
    shaking = tuple(GroundMotion(motions[j]) for j in columns.tolist())
    grid = Cases(
        systems, shaking, np.ascontiguousarray(scales[columns]), Request(), threads
    )
    wanted = chosen[np.ix_(rows, columns)][..., np.newaxis]
    found = contact_outcomes(grid, wanted)[..., 0]
    outcomes = np.zeros(chosen.shape, found.dtype)
    outcomes[np.ix_(rows, columns)] = found
    return outcomes


def _never_turns(body: Body, friction: tuple[float, ...]) -> bool:
    """Whether nothing can rise or slide off from rest, whatever the horizontal motion (docs/contact.md)."""
    system = body.system()
    rises = min(uplift_ratios(system))
    upright = system.contacts[0].tilt == 0 and friction[0] == min(friction)
    return upright and friction[0] < rises
