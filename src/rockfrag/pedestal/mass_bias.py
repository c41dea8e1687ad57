"""What a difference must exceed to mean anything: noise of a test, and mass that was not counted.

The thesis computes accelerations from the shaker's force over the moved mass (section 3.4).  Mass
that was moved but not counted scales every acceleration; if the pedestal's share of it differs,
P/NP is biased by the same factor for every motion.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import pandas as pd
from scipy import stats

from rockfrag.errors import InputError
from rockfrag.thesis.specimens import THESIS_BODIES

MASSES: Mapping[str, float] = {name: body.mass for name, body in THESIS_BODIES.items()}
"""Masses of the thesis's specimens [kg]."""

SD_TEST = 0.10
"""Scatter of ln a of one test from ±1 % of geometry and ±0.02 of restitution [-]."""


def _nonnegative(name: str, mass: float) -> None:
    if not (math.isfinite(mass) and mass >= 0):
        raise InputError(f"Measurement model: {name} must be a mass of 0 kg or more, got {mass}.")


def ratio_bias(
    statue: float,
    pedestal: float,
    table: float,
    *,
    counted_with: float,
    counted_without: float,
) -> float:
    """Factor on P/NP when a is computed from force over the counted mass [-].

    The force F = (table + blocks) a moves everything; the reported figure is F over the counted
    mass.

    Parameters
    ----------
    statue, pedestal, table
        Moved masses [kg].
    counted_with, counted_without
        Masses that were divided by in tests with and without the pedestal [kg].

    Raises
    ------
    InputError
        If a mass is negative or a counted mass is not positive.
    """
    for name, mass in (("statue", statue), ("pedestal", pedestal), ("table", table)):
        _nonnegative(name, mass)
    for name, mass in (("counted_with", counted_with), ("counted_without", counted_without)):
        _nonnegative(name, mass)
        if mass == 0:
            raise InputError(f"Measurement model: {name} is 0 kg, and force is divided by it.")
    with_pedestal = (table + statue + pedestal) / counted_with
    without = (table + statue) / counted_without
    return with_pedestal / without


def mass_errors(
    table_masses: npt.ArrayLike = (2.0, 5.0, 10.0, 20.0),
    masses: Mapping[str, float] = MASSES,
) -> pd.DataFrame:
    """Bias of P/NP for two ways of miscounting, by object and mass of the table.

    ``pedestal not counted``: the same mass is divided by with and without the pedestal.  With a
    table of 10 kg this raises P/NP by 17 to 19 %.  ``table not counted``: only the blocks'
    weight is divided by (the words of section 3.4); this lowers P/NP.

    Returns
    -------
    pandas.DataFrame
        error, object, table_kg, ratio_bias [-].
    """
    rows: list[dict[str, object]] = []
    pedestal = masses["P"]
    for object_name in sorted(set(masses) - {"P"}):
        statue = masses[object_name]
        for table in np.asarray(table_masses, dtype=float):
            counted = {
                "pedestal not counted": (table + statue, table + statue),
                "table not counted": (statue + pedestal, statue),
            }
            for error, (with_pedestal, without) in counted.items():
                bias = ratio_bias(
                    statue,
                    pedestal,
                    float(table),
                    counted_with=with_pedestal,
                    counted_without=without,
                )
                rows.append(
                    {
                        "error": error,
                        "object": object_name,
                        "table_kg": float(table),
                        "ratio_bias": bias,
                    }
                )
    return pd.DataFrame(rows)


@dataclass(frozen=True)
class Noise:
    """Scatter of one test and what follows for pairs.

    Parameters
    ----------
    sd_test
        Standard deviation of ln a of one test [-].
    lower, upper
        Its 95 % interval [-]; NaN if assumed and not estimated.
    sd_pair
        Standard deviation of d, √2 sd_test for independent tests [-].
    """

    sd_test: float
    lower: float
    upper: float
    sd_pair: float


def noise_from_repetitions(ln_a: pd.Series, group: pd.Series) -> Noise:
    """Scatter of a test from repetitions (real ones or simulated perturbations).

    Parameters
    ----------
    ln_a
        ln of the overturning amplitude [-].
    group
        Which rows repeat the same test.

    Raises
    ------
    InputError
        If no test was repeated.
    """
    deviation = ln_a - ln_a.groupby(group).transform("mean")
    free = len(ln_a) - group.nunique()
    if free < 1:
        raise InputError("Noise of a test: no test was repeated; give repetitions of at least one.")
    square = float((deviation**2).sum())
    sd = math.sqrt(square / free)
    lower, upper = (math.sqrt(square / float(stats.chi2.ppf(q, free))) for q in (0.975, 0.025))
    return Noise(sd, lower, upper, math.sqrt(2) * sd)


def step_scatter(step: float) -> float:
    """Scatter of ln a of one test because the amplitude is raised in steps of a ratio 1 + step [-].

    The overturning amplitude lies anywhere in the last step, so ln a is uniform over ln(1 + step).
    """
    return math.log1p(step) / math.sqrt(12)
