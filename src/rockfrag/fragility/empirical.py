"""Outcomes without a curve: fractions in bins and near a value, structural resurrections, brackets of IDA curves.

In: observations or tables of incremental dynamic analyses (IDA), a row per motion and amplitude. Out: tables of
fractions with binomial limits [-], of resurrections, and the brackets of overturning amplitudes.

Theory: ``docs/fragility.md``, "Estimators" (first and always overturning); Wilson (1927) for the limits.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray
from scipy import special

from rockfrag.base.errors import InputError
from rockfrag.fragility import observations
from rockfrag.fragility.censored import Brackets, brackets_from_table
from rockfrag.fragility.observations import Floats, Observations
from rockfrag.shaketable.definitions import Swept


def wilson_interval(
    overturned: ArrayLike, trials: ArrayLike, level: float = 0.90
) -> tuple[Floats, Floats]:
    """Confidence limits of binomial fractions (Wilson, 1927, J. Am. Stat. Assoc. 22: 209-212).

    Parameters
    ----------
    overturned, trials : numbers of tests that overturned and of all, shape (n,)
    level : two-sided confidence level [-]

    Returns
    -------
    Lower and upper limits [-], shape (n,) each.
    """
    n = np.asarray(trials, dtype=np.float64)
    p = np.asarray(overturned, dtype=np.float64) / n
    score = -special.ndtri((1.0 - level) / 2.0)
    square = score**2
    wider = 1 + square / n
    middle = (p + square / (2 * n)) / wider
    half = score * np.sqrt(p * (1.0 - p) / n + square / (4.0 * n**2)) / wider
    return np.clip(middle - half, 0.0, 1.0), np.clip(middle + half, 0.0, 1.0)


def fraction_in_bins(outcomes: Observations, level: float = 0.90) -> pd.DataFrame:
    """Fraction of overturned tests in ten bins of about equal numbers of tests; up to ten levels keep a bin each.

    Parameters
    ----------
    outcomes, level : the tests, and the level of the binomial limits [-], in which a motion counts once in a bin

    Returns
    -------
    pandas.DataFrame
        A row a bin: ``im`` (geometric mean), ``im_lower``, ``im_upper`` in the unit of the measure; ``tests``,
        ``motions``, ``overturned``; ``fraction``, ``fraction_lower``, ``fraction_upper`` [-].
    """
    code = observations.cells(outcomes.im, 10, outcomes.trials)[0]
    rows, once = [], []
    for k in np.unique(code):
        inside = code == k
        im, trials = outcomes.im[inside], outcomes.trials[inside]
        fell = outcomes.overturned[inside]
        motions, counted_once = outcomes.independent(inside)
        middle = np.exp(np.average(outcomes.log_im[inside], weights=trials))
        rows.append(
            {
                "im": middle,
                "im_lower": im.min(),
                "im_upper": im.max(),
                "tests": int(trials.sum()),
                "motions": motions,
                "overturned": int(fell.sum()),
                "fraction": fell.sum() / trials.sum(),
            }
        )
        once.append(counted_once)
    table, alone = pd.DataFrame(rows), np.array(once)
    lower, upper = wilson_interval(table["fraction"].to_numpy() * alone, alone, level)
    return table.assign(fraction_lower=lower, fraction_upper=upper)


def local_fraction(outcomes: Observations, im: ArrayLike) -> Floats:
    """Fraction of overturned tests near each ``im``, weighted by a normal kernel in ln IM; may fall.

    The kernel's standard deviation in ln IM is 0.53 s n^(-1/5), half of Silverman's, which would flatten a steep
    rise; the tests have different values, so that it is above zero.

    Parameters
    ----------
    outcomes, im : the tests, and values of their measure, in its unit, shape (n,)

    Returns
    -------
    The fractions [-], shape (n,).
    """
    mean = np.average(outcomes.log_im, weights=outcomes.trials)
    variance = np.average((outcomes.log_im - mean) ** 2, weights=outcomes.trials)
    bandwidth = 0.53 * float(np.sqrt(variance)) * outcomes.n ** (-0.2)
    outcomes = outcomes.by_value()
    x = outcomes.log_im
    fraction = outcomes.overturned / outcomes.trials
    found = []
    # one after the other, so that memory holds one row of weights
    for middle in np.log(np.atleast_1d(np.asarray(im, dtype=np.float64))):
        # the largest exponent is taken out so that far values still have weights
        power = -0.5 * ((middle - x) / bandwidth) ** 2
        weight = np.exp(power - power.max()) * outcomes.trials
        found.append((weight * fraction).sum() / weight.sum())
    return np.array(found)


def find_resurrections(
    ida: pd.DataFrame, *, amplitude: str = "amplitude_g", by: str | list[str] = "motion"
) -> pd.DataFrame:
    """Find where each motion first overturns, where it always does, and the windows between, a row an IDA curve.

    Parameters
    ----------
    ida : a row per motion and amplitude, with ``overturned``
    amplitude, by : column of the amplitude, and the columns by which IDA curves differ

    Returns
    -------
    pandas.DataFrame
        Columns: ``by``; ``first_lower``, ``first_upper``: the largest amplitude below the first overturning and
        that overturning; ``always_lower``, ``always_upper``: the largest amplitude survived and the next one;
        ``resurrections``: number of ranges survived above the first overturning; ``window_width``: sum of their
        widths in ln amplitude, each counted between the middles of its bounding steps. Lower bounds are 0 where
        nothing lower was tried, upper ones NaN where nothing overturned.
    """
    keys = [by] if isinstance(by, str) else by
    values = observations.positive(ida, amplitude)
    fell = observations.read_observations(ida, "overturned") == 1
    table = ida[keys].assign(amplitude=values, overturned=fell)
    repeated = table.duplicated([*keys, "amplitude"]).to_numpy()
    if repeated.any():
        row = int(repeated.argmax())
        curve = ", ".join(table[keys].iloc[row].astype(str))
        raise InputError(
            f"table, row {row + 1}, column {amplitude!r}: the IDA curve of {curve} already has the amplitude "
            f"{values[row]:g}; leave the repetition out."
        )
    rows = []
    for name, group in table.groupby(keys, sort=True):
        ordered = group.sort_values("amplitude")
        found = _resurrections(
            ordered["amplitude"].to_numpy(), ordered["overturned"].to_numpy()
        )
        rows.append({**dict(zip(keys, name, strict=True)), **found})
    return pd.DataFrame(rows)


def resurrections_of(parts: Iterable[Swept]) -> pd.DataFrame:
    """Structural resurrections of parts of IDA curves, as :func:`find_resurrections` has those of a table.

    Parameters
    ----------
    parts : IDA curves of some motions each, see :class:`rockfrag.shaketable.definitions.Swept`

    Returns
    -------
    A row an IDA curve, with ``configuration``, ``earthquake``, ``floor``, ``motion`` and the columns of
    :func:`find_resurrections`.
    """
    keys = ["configuration", "earthquake", "floor", "motion"]
    rows: list[dict[Hashable, object]] = []
    for part in parts:
        curves = zip(part.about[keys].to_dict("records"), part.overturned, strict=True)
        rows += [
            about | _resurrections(part.amplitude_g, fell) for about, fell in curves
        ]
    return pd.DataFrame(rows).sort_values(keys, ignore_index=True)


def _resurrections(
    amplitude: Floats, overturned: NDArray[np.bool_]
) -> dict[str, float | int]:
    """Bounds of the first amplitude that overturns and of that above which all do; how much survives between them.

    ``resurrections`` counts the windows of amplitudes that survive, ``window_width`` adds up their widths [ln].
    """
    fell, stood = np.flatnonzero(overturned), np.flatnonzero(~overturned)
    first = fell[0] if fell.size else amplitude.size
    always = stood[-1] + 1 if stood.size else 0
    bounds = [0.0, *amplitude.tolist(), float("nan")]
    # between the first overturning and the end outcomes change in turns, to survived and back
    middles = np.sqrt(amplitude[1:] * amplitude[:-1])
    changes = middles[np.flatnonzero(np.diff(overturned))][0 if overturned[0] else 1 :]
    windows = list(zip(changes[::2], changes[1::2], strict=False))
    return {
        "first_lower": bounds[first],
        "first_upper": bounds[first + 1],
        "always_lower": bounds[always],
        "always_upper": bounds[always + 1],
        "resurrections": len(windows),
        "window_width": sum((float(np.log(high / low)) for low, high in windows), 0.0),
    }


@dataclass(frozen=True)
class TableIda:
    """IDA curves of one configuration, as a table with a row per motion and amplitude."""

    # with ``motion``, ``overturned``, the amplitude and the measures
    table: pd.DataFrame
    # column of the earthquake; None where motions have none
    earthquake: str | None = "earthquake"
    motion: str = "motion"  # column of the motion

    def resurrections(self, amplitude: str) -> pd.DataFrame:
        """Structural resurrections, a row a motion: see :func:`find_resurrections`."""
        by = [name for name in (self.motion, self.earthquake) if name is not None]
        return find_resurrections(self.table, amplitude=amplitude, by=by)

    def brackets(
        self, windows: pd.DataFrame, definition: str, amplitude: str
    ) -> Brackets:
        """Bounds of each motion's ``first`` amplitude that overturns, or that above which all ``always`` do."""
        return brackets_from_table(
            windows,
            lower=f"{definition}_lower",
            upper=f"{definition}_upper",
            motion=self.motion,
            earthquake=self.earthquake,
            measure=amplitude,
        )

    def outcomes(self, column: str) -> Observations:
        """All outcomes with a measure."""
        return observations.observations_from_table(
            self.table,
            column,
            motion=self.motion,
            earthquake=self.earthquake,
            source="ida",
        )

    def motions(self) -> pd.DataFrame:
        """One row per motion."""
        return self.table.drop_duplicates(self.motion)
