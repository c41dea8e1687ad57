"""Which perturbed parameter of the ideal model, or which two together, would give an effect that was asked for.

The question of `rockfrag_thesis.sensitivity_analysis.explain` turned round.  Every factor was varied alone;
between its levels its change of ln P/NP is taken as straight, beyond them nothing is said, and changes of two
factors are added.  For a wanted effect on the ground and above it, the levels are found at which the model comes
closest, and all levels that the model's own earthquakes do not exclude: Hotelling's T² over earthquakes, of
what lies beyond the series of levels's resolution.
"""

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import pandas as pd
from scipy import special

from rockfrag.effects.cluster_means import Array

PLAUSIBLE = 0.05
"""Levels whose T² has a smaller p value, times the number of mechanisms tried, are excluded [-]."""

LEAST_SCATTER = 0.005
"""Standard deviation of ln P/NP between earthquakes that a model is never taken to be more robust than [-]."""

# largest difference of ln P/NP at which the wanted effect counts as reached [-]
REACH = 0.02

POINTS = 25  # levels tried along each factor

FRICTION = ("ground_friction", "interface_friction")
"""Coefficient of friction of the ground alone, and of the interface alone, as factors."""

NEUTRAL: Mapping[str, float] = {
    "statue_restitution": 1.0,
    "interface_restitution": 1.0,
    "ground_restitution": 1.0,
    "pedestal_lean_deg": 0.0,
    "statue_offset_mm": 0.0,
    "statue_cg_offset_mm": 0.0,
}
"""Level of the ideal model, where it is the same for all objects; a pedestal's width is its own."""

BY_INVERSE = ("pedestal_not_counted", "table_not_counted")
"""Factors that vanish as their level grows without end: they are taken as straight in 1/level."""

COLUMNS = [
    *("factor_1", "level_1", "level_1_low", "level_1_high"),
    *("factor_2", "level_2", "level_2_low", "level_2_high"),
    *("acts_on", "ground", "above", "p", "plausible", "reaches"),
]


def friction_perturbations(tried: pd.DataFrame) -> pd.DataFrame:
    """Friction of the ground alone and of the interface alone as two factors, as `invert` takes them.

    Infinite coefficients are the ideal model.
    """
    rough = {
        name: np.isinf(tried[name].to_numpy(dtype=np.float64))
        for name in ("ground", "interface")
    }
    parts: list[pd.DataFrame] = []
    for factor, varied, other in zip(FRICTION, rough, reversed(rough), strict=True):
        level = [f"{value:g}" for value in tried[varied]]
        rows = tried.assign(factor=factor, level=level, reference=rough[varied])
        parts.append(rows[rough[other]])
    return pd.concat(parts, ignore_index=True)


@dataclass(frozen=True)
class _Line:
    """Changes of ln P/NP by earthquake along one factor, shape (points, earthquakes, floors), and its levels."""

    factor: str
    level: Array
    change: Array


def invert(
    ratios: pd.DataFrame,
    wanted: Mapping[str, float],
    floors: Mapping[str, int],
    neutral: Mapping[str, float] = NEUTRAL,
    resolution: float = 0.0,
) -> pd.DataFrame:
    """Find the perturbed parameters, alone and in pairs, that come closest to a wanted effect.

    Ratios are as `rockfrag_thesis.sensitivity_analysis.explain.explain` takes them; levels are text, numbers where
    they can be varied continuously. ``wanted`` is P/NP on the ``ground`` and ``above`` it [-]; either may be
    missing. Floors have levels by label, 0 is the ground; ``neutral`` is the level of the ideal model by factor,
    and of a factor without one only the levels themselves are tried; ``resolution`` is ln(1 + step) of the series
    of levels [-].

    Returns one row per factor, acting everywhere, on the ``ground`` alone or ``above`` alone, and per pair of
    factors, the closest first: factor_1, level_1, level_1_low, level_1_high (levels that are not excluded with all
    mechanisms counted, Bonferroni; empty where all are); the same of factor_2 (empty for one factor); acts_on;
    ground, above (P/NP of the model there); p (of the wanted effect under the model's scatter between earthquakes;
    NaN with too few earthquakes); plausible; reaches (both ratios within 2 % of the wanted ones).
    """
    places = [name for name in ("ground", "above") if name in wanted]
    cells = _by_earthquake(ratios, floors, places)
    ideal = cells.pop(("", ""))
    goal = np.log([wanted[name] for name in places])
    lines = _lines(cells, ideal, neutral)
    start = ideal.to_numpy(dtype=np.float64)
    found = []
    everywhere_or_not = ("all floors", *(places if len(places) > 1 else []))
    mechanisms = len(lines) * len(everywhere_or_not) + math.comb(len(lines), 2)
    least_p = PLAUSIBLE / max(mechanisms, 1)
    row = partial(
        _row, goal=goal, places=places, resolution=resolution, least_p=least_p
    )
    for line in lines:
        for acts_on in everywhere_or_not:
            mask = np.array(
                [acts_on in ("all floors", name) for name in places], dtype=float
            )
            tried = start + line.change * mask
            found.append(row([line], tried, acts_on))
    for first, two in itertools.combinations(lines, 2):
        both = first.change[:, None] + two.change[None, :]
        tried = start + both.reshape(-1, *both.shape[2:])
        found.append(row([first, two], tried, "all floors"))
    table = pd.DataFrame(found, columns=[*COLUMNS, "distance"])
    table = table.sort_values("distance", kind="stable", ignore_index=True)
    return table.drop(columns="distance")


def _by_earthquake(
    ratios: pd.DataFrame, floors: Mapping[str, int], places: Sequence[str]
) -> dict[tuple[str, str], pd.DataFrame]:
    """Mean of ln P/NP of the ideal model, under empty names, and its mean change by factor and level.

    Shape (earthquakes, places). A change is that of each pair of tests, and then a mean over those that are known
    at the level and in the ideal model, so that an object that no longer falls is not mistaken for an effect.
    """
    work = ratios.assign(
        d=np.log(ratios["ratio"].astype(float)),
        place=[
            "ground" if floors.get(str(floor), 1) == 0 else "above"
            for floor in ratios["floor"]
        ],
        level=ratios["level"].astype(str),
        reference=ratios["reference"].astype(bool),
    )
    work = work[work["place"].isin(places)]
    pair = ["factor", "object", "earthquake", "place", "motion"]
    each = work.groupby([*pair, "level", "reference"])["d"].mean().reset_index()
    ideal = each[each["reference"]].drop(columns=["level", "reference"])
    perturbed = each[~each["reference"]].merge(ideal, on=pair, suffixes=("", "_ideal"))
    perturbed["d"] -= perturbed["d_ideal"]
    tables = [ideal.assign(factor="", level=""), perturbed]
    known = pd.concat(tables, ignore_index=True).dropna(subset="d")
    by_motion = known.groupby(["factor", "level", "earthquake", "place", "motion"])[
        "d"
    ].mean()
    means = by_motion.reset_index().pivot_table(
        index=["factor", "level", "earthquake"], columns="place", values="d"
    )
    wide = means.reindex(columns=list(places)).dropna()
    return {
        (str(factor), str(level)): rows.droplevel(["factor", "level"])
        for (factor, level), rows in wide.groupby(level=["factor", "level"])
    }


def _lines(
    cells: Mapping[tuple[str, str], pd.DataFrame],
    ideal: pd.DataFrame,
    neutral: Mapping[str, float],
) -> list[_Line]:
    """Changes along each factor whose levels are numbers and share the ideal model's earthquakes."""
    lines = []
    for name in dict.fromkeys(factor for factor, _ in cells):
        if name in ("step_percent", "tolerances"):
            continue
        known = []
        for (factor, level), rows in cells.items():
            if factor == name and set(ideal.index) <= set(rows.index):
                known.append((float(level), rows.loc[ideal.index].to_numpy()))
        if not known:
            continue
        x = np.array(
            [1.0 / level if name in BY_INVERSE else level for level, _ in known]
        )
        change = np.array([value for _, value in known])
        at_rest = 0.0 if name in BY_INVERSE else neutral.get(name)
        if at_rest is None:
            lines.append(_Line(name, x, change))
            continue
        x, change = np.append(x, at_rest), np.concatenate([change, 0.0 * change[:1]])
        order = np.argsort(x)
        grid = np.linspace(x.min(), x.max(), POINTS)
        flat = change[order].reshape(len(x), -1)
        between = [np.interp(grid, x[order], column) for column in flat.T]
        straight = np.column_stack(between).reshape(POINTS, *change.shape[1:])
        with np.errstate(divide="ignore"):
            shown = 1.0 / grid if name in BY_INVERSE else grid
        lines.append(_Line(name, shown, straight))
    return lines


def _row(
    lines: Sequence[_Line],
    tried: Array,
    acts_on: str,
    *,
    goal: Array,
    places: Sequence[str],
    resolution: float,
    least_p: float,
) -> dict[str, object]:
    """Closest point of one or two factors, and what is not excluded around it."""
    p = hotelling(tried, goal, resolution)
    distance = np.abs(tried.mean(axis=1) - goal).max(axis=1)
    best = int(distance.argmin())
    inside = p >= least_p
    shape = [line.level.size for line in lines]
    at = np.unravel_index(best, shape)
    reached = np.unravel_index(np.flatnonzero(inside), shape)
    row: dict[str, object] = {
        "acts_on": acts_on,
        "p": float(p[best]),
        "distance": distance[best],
    }
    for number, line in enumerate(lines, start=1):
        levels = line.level[reached[number - 1]]
        row |= {
            f"factor_{number}": line.factor,
            f"level_{number}": float(line.level[at[number - 1]]),
            f"level_{number}_low": float(levels.min()) if levels.size else np.nan,
            f"level_{number}_high": float(levels.max()) if levels.size else np.nan,
        }
    if len(lines) == 1:
        row |= {
            "factor_2": "",
            "level_2": np.nan,
            "level_2_low": np.nan,
            "level_2_high": np.nan,
        }
    mean = tried[best].mean(axis=0)
    row |= dict(zip(places, np.exp(mean), strict=True))
    row["plausible"] = bool(inside.any())
    row["reaches"] = bool(distance[best] <= REACH)
    return row


def hotelling(values: Array, goal: Array, resolution: float) -> Array:
    """P values of a goal, shape (places,), as the mean over earthquakes (Hotelling 1931) [-], shape (points,).

    Values are logarithms by earthquake, shape (points, earthquakes, places), each known to ``resolution`` [-]; a
    goal nearer than that cannot be told from the mean. NaN where there are no more earthquakes than places.
    """
    points, earthquakes, places = values.shape
    if earthquakes <= places:
        return np.full(points, np.nan)
    mean = values.mean(axis=1)
    offset = values - mean[:, None]
    covariance = np.einsum("pei,pej->pij", offset, offset) / (earthquakes - 1)
    covariance += np.eye(places) * LEAST_SCATTER**2
    away = np.sign(mean - goal) * np.maximum(np.abs(mean - goal) - resolution, 0.0)
    inverse = np.linalg.solve(covariance, away[..., None])[..., 0]
    distance = earthquakes * np.einsum("pi,pi->p", away, inverse)
    scaled = distance * (earthquakes - places) / (places * (earthquakes - 1))
    return np.asarray(special.fdtrc(places, earthquakes - places, scaled))
