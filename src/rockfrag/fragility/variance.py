"""What part of the scatter of the overturning amplitude comes from motion, parameters, fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.fragility.observations import Floats, labels, numbers, positive
from rockfrag.short_repr import short_repr


@dataclass(frozen=True)
class VarianceSplit:
    """Law of total variance for ln amplitude in an ensemble of motions × parameter samples.

    Attributes
    ----------
    table
        ``component``, ``variance``, ``fraction`` (of the total), ``standard_deviation``. Components:
        ``motion``; ``parameters``; below it one row per given parameter and ``other parameters``
        where parameters are named (their sum is ``parameters``); ``motion x parameters`` (what is
        left, chance included); ``total``; ``fit``: the variance of ln θ itself because motions are
        few, not part of the total.
    log_theta, beta
        Mean of ln amplitude and square root of the total variance.
    motions, samples
        Numbers of motions and parameter samples.
    warnings
        Names components whose estimate came out negative and was set to zero.
    """

    table: pd.DataFrame
    log_theta: float
    beta: float
    motions: int
    samples: int
    warnings: tuple[str, ...]

    __repr__ = short_repr


def split_variance(
    ensemble: pd.DataFrame,
    *,
    amplitude: str = "amplitude_g",
    motion: str = "motion",
    sample: str = "sample",
    parameters: Sequence[str] = (),
) -> VarianceSplit:
    """Split the variance of ln amplitude by analysis of variance of a complete crossed ensemble.

    Parameters
    ----------
    ensemble
        One row per motion and parameter sample, each pair once.
    amplitude
        Column of the overturning amplitude.
    motion, sample
        Columns with the labels.
    parameters
        Columns with the value of each parameter (restitution, width, …) in the sample; their fractions
        are the squared slopes of a linear regression of the samples' means, less the square of
        their standard error.

    Returns
    -------
    The :class:`VarianceSplit`.

    Raises
    ------
    InputError
        If a pair is missing or double, there are fewer than two motions or samples, an amplitude is
        missing or not above zero, or there are too few samples for the named parameters.
    """
    values = pd.DataFrame(
        {
            "motion": labels(ensemble, motion, "ensemble"),
            "sample": labels(ensemble, sample, "ensemble"),
            "y": np.log(positive(ensemble, amplitude, "ensemble")),
        }
    )
    doubled = values.duplicated(["motion", "sample"])
    if doubled.any():
        row = int(np.flatnonzero(doubled)[0])
        raise InputError(
            f"ensemble, row {row + 1}: motion {values['motion'].iloc[row]!r} with sample "
            f"{values['sample'].iloc[row]!r} is there twice; leave one out."
        )
    wide = values.pivot_table(index="motion", columns="sample", values="y", aggfunc="first")
    if wide.isna().to_numpy().any():
        where = np.argwhere(wide.isna().to_numpy())[0]
        raise InputError(
            f"ensemble: motion {wide.index[where[0]]!r} has no amplitude with sample "
            f"{wide.columns[where[1]]!r}; every motion needs every sample."
        )
    grid = wide.to_numpy()
    motions, samples = grid.shape
    if motions < 2 or samples < 2:
        raise InputError(
            f"ensemble: {motions} motions and {samples} samples; a split needs two of each at "
            "least."
        )
    notes: list[str] = []
    by_motion, by_sample, rest = _components(grid)
    parts = {"motion": by_motion, "parameters": by_sample, "motion x parameters": rest}
    for name, value in parts.items():
        if value < 0:
            notes.append(f"The variance of {name} was estimated as {value:.2g} and set to zero.")
            parts[name] = 0.0
    total = sum(parts.values())
    rows = [("motion", parts["motion"]), ("parameters", parts["parameters"])]
    if parameters:
        named = _by_parameter(ensemble, wide, sample, parameters)
        rows += [(f"parameters: {name}", value) for name, value in named.items()]
        other = max(parts["parameters"] - sum(named.values()), 0.0)
        rows.append(("other parameters", other))
    rows += [
        ("motion x parameters", parts["motion x parameters"]),
        ("total", total),
        ("fit", float(grid.mean(axis=1).var(ddof=1) / motions)),
    ]
    table = pd.DataFrame(rows, columns=["component", "variance"])
    table["fraction"] = table["variance"] / total if total > 0 else np.nan
    table["standard_deviation"] = np.sqrt(table["variance"])
    return VarianceSplit(
        table, float(grid.mean()), float(np.sqrt(total)), motions, samples, tuple(notes)
    )


def _components(grid: Floats) -> tuple[float, float, float]:
    """Unbiased variance components of a two-way table without repetition (random effects)."""
    motions, samples = grid.shape
    rows, columns = grid.mean(axis=1), grid.mean(axis=0)
    rest = grid - rows[:, None] - columns + grid.mean()
    within = float((rest**2).sum() / ((motions - 1) * (samples - 1)))
    return (
        float(rows.var(ddof=1) - within / samples),
        float(columns.var(ddof=1) - within / motions),
        within,
    )


def _by_parameter(
    ensemble: pd.DataFrame, wide: pd.DataFrame, sample: str, parameters: Sequence[str]
) -> dict[str, float]:
    samples = wide.shape[1]
    if samples < len(parameters) + 3:
        raise InputError(
            f"ensemble: {samples} samples are too few to tell {len(parameters)} parameters apart; "
            f"give at least {len(parameters) + 3}."
        )
    for column in parameters:
        numbers(ensemble, column, "ensemble")
    by_sample = ensemble.groupby(sample)[list(parameters)]
    if (by_sample.max() > by_sample.min()).to_numpy().any():
        raise InputError(
            f"ensemble, columns {', '.join(parameters)}: a sample has two values of one "
            "parameter; every sample needs one."
        )
    x = by_sample.first().loc[wide.columns].to_numpy(dtype=np.float64)
    spread = x.std(axis=0, ddof=1)
    if (spread == 0).any():
        fixed = parameters[int(np.flatnonzero(spread == 0)[0])]
        raise InputError(f"ensemble, column {fixed!r}: the parameter never varies; leave it out.")
    design = np.column_stack([np.ones(samples), (x - x.mean(axis=0)) / spread])
    means = wide.to_numpy().mean(axis=0)
    slopes, *_ = np.linalg.lstsq(design, means, rcond=None)
    residual = means - design @ slopes
    scatter = residual @ residual / (samples - design.shape[1])
    errors = scatter * np.diag(np.linalg.pinv(design.T @ design))
    return {
        name: float(max(slopes[k + 1] ** 2 - errors[k + 1], 0.0))
        for k, name in enumerate(parameters)
    }
