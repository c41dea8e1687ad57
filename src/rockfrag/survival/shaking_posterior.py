"""How strongly the ground shook, by what fell and what still stands: a posterior of PGV and of PGA.

In one earthquake all objects of a place feel one motion, of which only its like is known: the motions of a set.
Under the motion m at the peak velocity v an object of the group k falls with

    p_k(v, m, s) = E[F_k(v exp(-s - e), m)],    e normal with the spread of one object of the group to the next,

where F_k(v, m) is whether the motion scaled to v topples the object as it is drawn, and s is what the whole place
shares: errors of the model and of what was measured of all alike. The numbers of fallen are binomial once m and s
are given, and the likelihood is the mean over both,

    L(v) = E_m E_s Π_k Bin(f_k; n_k, p_k(v, m, s)),

so that what all objects share does not average out, however many they are. The acceleration that goes with v is
that of each motion, weighted by what is known of PGV/PGA. ``docs/constrain-shaking.md`` derives and tests it.

In: fractions toppled at each level by motion, and counts. Out: probabilities of levels of PGV [cm/s] and PGA [g].
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError

INTERVAL = 0.90  # Probability that the interval holds
LEAST_LIKELIHOOD = (
    1e-300  # Of a level over that of the likeliest one under the same motion [-]
)
LEAST = 1e-9  # Least probability of a fall, and of none: an object may fall for reasons of its own [-]
AT_THE_END = (
    0.02  # Probability at an end of the levels from which the interval is open there
)


@dataclass(frozen=True)
class Falls:
    """What happened to a group of like objects, and what motions do to one of them.

    Attributes
    ----------
    fallen, count : how many fell, of how many
    toppled : whether, or in which part of cases, a motion at a level topples one, shape (motions, levels)
    spread : standard deviation of ln level that fells one object of the group and the next [-]
    """

    fallen: int
    count: int
    toppled: Floats
    spread: float


@dataclass(frozen=True)
class Prior:
    """What is known of the shaking before the falls are looked at: ln PGV and ln PGA are normal.

    Attributes
    ----------
    pgv : median PGV [cm/s]; NaN where nothing is known of it
    pgv_spread : standard deviation of its logarithm [-]
    pga : median PGA [g]; NaN where nothing is known of it
    pga_spread : standard deviation of its logarithm [-]
    correlation : between both [-]
    """

    pgv: float = np.nan
    pgv_spread: float = np.nan
    pga: float = np.nan
    pga_spread: float = np.nan
    correlation: float = 0.0

    @property
    def knows_something(self) -> bool:
        """Whether anything is known."""
        return bool(np.isfinite(self.pgv) or np.isfinite(self.pga))

    def log_weights(self, log_pgv: Floats, log_pga: Floats) -> Floats:
        """Logarithm of the probability of each motion at each level, but for a constant.

        PGV alone says nothing of which motion it was; PGA alone is that of each motion; of both PGA weighs the
        motions within a level, against how often its ratio to PGV is met in the set.

        Parameters
        ----------
        log_pgv : ln PGV of the levels, shape (levels,) [cm/s]
        log_pga : ln PGA of each motion at each level, shape (motions, levels) [g]

        Returns
        -------
        Logarithms, shape (motions, levels).
        """
        v = np.zeros(log_pgv.shape)
        if np.isfinite(self.pgv):
            v = (log_pgv - np.log(self.pgv)) / self.pgv_spread
        if not np.isfinite(self.pga):
            return np.asarray(-0.5 * v**2 + np.zeros(log_pga.shape))
        a = (log_pga - np.log(self.pga)) / self.pga_spread
        if not np.isfinite(self.pgv):
            return np.asarray(-0.5 * a**2)
        left = 1.0 - self.correlation**2
        within = -0.5 * (a - self.correlation * v) ** 2 / left - _log_met(log_pga)
        within -= special.logsumexp(within, axis=0)
        return np.asarray(-0.5 * v**2 + within)


def _log_met(log_pga: Floats) -> Floats:
    """Logarithm of how often motions of a set have the PGA that they have at a PGV, shape (motions, 1).

    Their ln PGA/PGV are taken for normal. ``log_pga``: shape (motions, levels).
    """
    ratio = log_pga[:, :1] - log_pga[:, :1].mean()
    spread = float(ratio.std())
    return np.asarray(-0.5 * (ratio / spread) ** 2 if spread > 0 else 0.0 * ratio)


@dataclass(frozen=True, eq=False)
class ShakingPosterior:
    """How strongly the ground shook, after the falls were looked at.

    Attributes
    ----------
    levels : of PGV, rising, shape (levels,) [cm/s]
    probability : of each level, of sum 1, shape (levels,)
    prior : the same before
    accelerations : PGA of each motion at each level, shape (motions, levels) [g]
    joint : probability of each motion and level, of sum 1, shape (motions, levels)
    """

    levels: Floats
    probability: Floats
    prior: Floats
    accelerations: Floats
    joint: Floats

    def pgv(self) -> tuple[float, float, float]:
        """Median PGV, and the limits that hold it with 90 % [cm/s]."""
        return self._median_and_limits(self.probability)

    def pgv_before(self) -> tuple[float, float, float]:
        """Return the same before the falls were looked at [cm/s]."""
        return self._median_and_limits(self.prior)

    def _median_and_limits(self, probability: Floats) -> tuple[float, float, float]:
        """Median and both limits of the levels with a probability, shape (levels,) [cm/s]."""
        low, middle, high = np.exp(_quantiles(np.log(self.levels), probability))
        return float(middle), float(low), float(high)

    def pga(self) -> tuple[float, float, float]:
        """Median PGA, and the limits that hold it with 90 % [g]."""
        values, weights = self.accelerations.ravel(), self.joint.ravel()
        order = np.argsort(values)
        cumulative = np.cumsum(weights[order])
        at = np.interp(_PARTS, cumulative / cumulative[-1], np.log(values[order]))
        low, middle, high = np.exp(at).tolist()
        return middle, low, high

    @property
    def open_below(self) -> bool:
        """Whether weaker shaking than the weakest level would do as well."""
        return bool(self.probability[0] > AT_THE_END * self.probability.max())

    @property
    def open_above(self) -> bool:
        """Whether stronger shaking than the strongest level would do as well."""
        return bool(self.probability[-1] > AT_THE_END * self.probability.max())

    @property
    def information_bit(self) -> float:
        """Information of the falls: divergence of what is known after from what was known before [bit]."""
        known = self.probability > 0
        ratio = self.probability[known] / np.maximum(self.prior[known], 1e-300)
        return float(self.probability[known] @ np.log2(ratio))


_PARTS = np.array([(1 - INTERVAL) / 2, 0.5, (1 + INTERVAL) / 2])


def shaking_posterior(
    levels: Floats,
    accelerations: Floats,
    falls: Sequence[Falls],
    *,
    shared_spread: float,
    prior: Prior | None = None,
    allowed: Floats | None = None,
) -> ShakingPosterior:
    """Posterior of PGV and PGA by what fell and what stands.

    Parameters
    ----------
    levels : of PGV, rising by a constant factor, shape (levels,) [cm/s]
    accelerations : PGA of each motion at each level, shape (motions, levels) [g]
    falls : what happened to each group
    shared_spread : standard deviation of ln level that all objects share [-]
    prior : what is known of the shaking before; None for nothing
    allowed : weight of each motion at each level, 0 where it cannot be scaled so far, shape (motions, levels)

    Returns
    -------
    The :class:`ShakingPosterior`.

    Raises
    ------
    InputError
        If counts are impossible, or no motion at any level explains them.
    """
    for group in falls:
        if not 0 <= group.fallen <= group.count or group.count < 1:
            raise InputError(
                f"falls: {group.fallen} of {group.count} objects cannot have fallen; give counts such as 31 of 60."
            )
    x = np.log(levels)
    logs = np.zeros(accelerations.shape)
    for group in falls:
        chance = smoothed(x, group.toppled, group.spread)
        logs += _log_binomial(group.fallen, group.count, chance)
    likelihood = _mean_over_shared(logs, x, shared_spread)
    before = (prior or Prior()).log_weights(x, np.log(accelerations))
    if allowed is not None:
        with np.errstate(divide="ignore"):
            before = before + np.log(allowed)
    joint = before + likelihood
    if not np.isfinite(joint).any():
        raise InputError(
            "falls: no motion at any level explains them; check sizes and counts."
        )
    return ShakingPosterior(
        levels,
        _normalized(joint).sum(axis=0),
        _normalized(before).sum(axis=0),
        accelerations,
        _normalized(joint),
    )


def smoothed(x: Floats, values: Floats, spread: float) -> Floats:
    """Mean of the values of a motion at levels that are lognormally distributed about each level.

    Where the values say whether the motion topples one object, the mean is the probability that it topples an
    object of a group whose capacities are lognormally distributed about that object's.

    Parameters
    ----------
    x : ln of rising levels, shape (levels,)
    values : at each level, shape (motions, levels)
    spread : standard deviation of ln level [-]

    Returns
    -------
    Means, shape (motions, levels); beyond the levels nothing changes.
    """
    if spread <= 0:
        return np.asarray(values, dtype=np.float64)
    # a level stands for what lies nearest to it
    ends = np.concatenate([[-np.inf], (x[1:] + x[:-1]) / 2, [np.inf]])
    below = special.ndtr((ends - x[:, np.newaxis]) / spread)
    return np.asarray(values @ np.diff(below, axis=1).T)


def _mean_over_shared(logs: Floats, x: Floats, spread: float) -> Floats:
    """Logarithm of the mean likelihood where all objects withstand more or less by what they share.

    Whoever withstands exp(s) times as much is as likely to have fallen at a level as others are at one that is
    lower by s, so that the mean over s is one over levels, motion by motion.

    Parameters
    ----------
    logs : ln likelihood, shape (motions, levels), which is that of the result
    x : ln of the levels, shape (levels,)
    spread : standard deviation of s [-]
    """
    peaks = logs.max(axis=1, keepdims=True)
    means = smoothed(x, np.exp(logs - peaks), spread)
    return np.asarray(peaks + np.log(np.maximum(means, LEAST_LIKELIHOOD)))


def _log_binomial(fallen: int, count: int, chance: Floats) -> Floats:
    """Logarithm of the probability of so many falls of ``count``, each with a chance [-], of the shape of that."""
    p = np.clip(chance, LEAST, 1 - LEAST)
    choices = special.gammaln(count + 1) - special.gammaln(fallen + 1)
    choices -= special.gammaln(count - fallen + 1)
    return np.asarray(choices + fallen * np.log(p) + (count - fallen) * np.log1p(-p))


def _normalized(logs: Floats) -> Floats:
    """Weights of sum 1 from their logarithms, of the same shape."""
    weights = np.exp(logs - logs[np.isfinite(logs)].max())
    return np.asarray(weights / weights.sum())


def _quantiles(x: Floats, probability: Floats) -> Floats:
    """Quantiles ``_PARTS`` of a density on evenly spaced points x, each of which stands for what is nearest to it.

    ``probability``: of each point, shape (n,).
    """
    ends = np.concatenate([[x[0]], (x[1:] + x[:-1]) / 2, [x[-1]]])
    cumulative = np.concatenate([[0.0], np.cumsum(probability)])
    return np.asarray(np.interp(_PARTS, cumulative / cumulative[-1], ends))
