"""What the simulation says of a campaign before any of its outcomes is used, beside what was measured."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import stats

from rockfrag.campaign.comparison import Bools, Floats, MeasuredTests, curves_of
from rockfrag.errors import InputError

LEVEL = 0.90  # confidence of intervals
_Z = float(stats.norm.ppf(0.5 + LEVEL / 2))


@dataclass(frozen=True)
class BlindAnswer:
    """Median of the fragility, blind and measured."""

    measured: float  # Measured median
    # Median over the ways in which the object may stand, with 5 and 95 % of them
    median: float
    lower: float
    upper: float
    # Standard error of ln(simulated over measured), from resampled input motions [-]
    sampling: float
    dispersion: float  # Middle dispersion of the ways [-]

    @property
    def error(self) -> float:
        """ln(simulated over measured median) [-]."""
        return math.log(self.median / self.measured)

    @property
    def ways(self) -> float:
        """Standard deviation of ln median between the ways to stand [-]: 90 % of them as those of a normal."""
        return math.log(self.upper / self.lower) / (2 * _Z)

    def interval(self, model: float = 0.0) -> tuple[float, float]:
        """Limits of the median (90 %); ``model`` is the standard deviation of ln median of the model [-]."""
        other = _Z * math.hypot(self.sampling, model)
        low = math.hypot(math.log(self.median / self.lower), other)
        high = math.hypot(math.log(self.upper / self.median), other)
        return self.median * math.exp(-low), self.median * math.exp(high)


def blind_answer(tests: MeasuredTests, measure: Floats, simulated: Bools) -> BlindAnswer:
    """Hold ways to stand, ``simulated`` (ways, tests), against what was measured; no way is chosen by it."""
    measured = tests.overturned
    seen = replace(tests, level=LEVEL)
    table = seen.fragility(measure, {"blind": simulated.mean(axis=0)}).set_index("who")
    each = curves_of(measure, simulated.astype(np.float64), np.ones(simulated.shape))
    # a way in which nothing overturns has its median beyond all tests, one in which all does below them
    bound = np.where(simulated.mean(axis=1) < measured.mean(), np.inf, 0.0)
    medians = np.where(np.isfinite(each[:, 0]), each[:, 0], bound)
    low, middle, high = np.quantile(
        medians, [(1 - LEVEL) / 2, 0.5, (1 + LEVEL) / 2], method="nearest"
    )
    theta = float(table["theta"].to_dict()["measured"])
    ratio = table.loc["blind", ["theta_ratio_lower", "theta_ratio_upper"]].astype(float)
    if not (np.isfinite([theta, *ratio]).all() and 0 < middle < math.inf):
        raise InputError("the outcomes do not rise with the measure, so they have no median.")
    sampling = float(np.log(ratio.iloc[1] / ratio.iloc[0])) / (2 * _Z)
    dispersion = float(np.nanmedian(each[:, 1]))
    return BlindAnswer(theta, float(middle), float(low), float(high), sampling, dispersion)


def model_error(answers: Sequence[BlindAnswer]) -> tuple[float, float]:
    """Standard deviation of ln median that blind answers show [-], and what of it is beyond the ways to stand.

    The mean square error, and what of it exceeds the variance of the ways to stand (the moment estimate of a
    variance between studies, DerSimonian and Laird 1986, with equal weights). To each the variance of sampling is
    added: agreement by chance is no proof of a model without error.
    """
    square = float(np.mean([answer.error**2 for answer in answers]))
    sampling = float(np.mean([answer.sampling**2 for answer in answers]))
    ways = float(np.mean([answer.ways**2 for answer in answers]))
    return math.sqrt(square + sampling), math.sqrt(max(0.0, square - ways) + sampling)
