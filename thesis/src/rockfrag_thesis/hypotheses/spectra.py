"""C14 to C19: response spectra and rocking spectra of the ground motions.

In: ground motions [m/s²]. Out: an outcome a hypothesis. Theory: ``docs/hypotheses.md``, ``docs/motions.md``.
"""

import itertools
import math

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from rockfrag.base.arrays import Floats
from rockfrag.base.units import GRAVITY
from rockfrag.effects.cluster_means import Estimate
from rockfrag.motions.intensity import pgd, pgv
from rockfrag.motions.response_spectra import oscillator_response
from rockfrag.simulation import overturns
from rockfrag_thesis.hypotheses.hypothesis import (
    Finding,
    Result,
    Undecidable,
    hypothesis,
)
from rockfrag_thesis.hypotheses.outcomes import (
    SEEN,
    decided,
    finding_of,
    jackknife,
    known,
    most,
    ratios,
)
from rockfrag_thesis.hypotheses.setting import PERIODS, SIZES, Setting

DAMPINGS = (0.02, 0.10)
PERCENTS = tuple(100 * damping for damping in DAMPINGS)
LONG = 200.0  # a period that counts as infinite [s]
ROCKS = 0.01
"""Rotation below which a block hardly rocks and its spectrum has no shape, of the critical angle [-]."""
# small change of slenderness or damping whose effects are compared with it [-]
CHANGE = 0.05


@hypothesis(14, blocks=SIZES.size, ends=SIZES[[0, -1]])
def c14(setting: Setting) -> Result:
    """Rank correlation of peak rotation with 2π/p, and fraction of steps that rise."""
    correlations, rises = [], []
    for row in setting.spectra.rotation().reshape(-1, SIZES.size):
        # a block that overturned has the largest rotation of all
        if np.max(row) < ROCKS or np.unique(row).size < 10:
            continue
        correlations.append(float(stats.spearmanr(SIZES, row).statistic))
        rises.append(float((np.diff(row[np.isfinite(row)]) > 0).mean()))
    if not correlations:
        raise Undecidable("no block rocks by more than 1 % of its critical angle")
    falling = int(np.sum(np.array(correlations) < -0.5))
    return Result(
        most(falling, len(correlations)),
        f"{falling} of {len(correlations)} spectra nearly fall: ρ {np.median(correlations):.3f} (median; "
        f"{min(correlations):.3f} to {max(correlations):.3f}); {100 * np.mean(rises):.0f} % of the steps rise",
        float(np.median(correlations)),
        min(correlations),
        max(correlations),
        remark="limits: range over motions and slenderness",
    )


@hypothesis(15, ends=PERIODS[[0, -1]], long=LONG)
def c15(setting: Setting) -> Result:
    """Displacement spectrum: the rise to its maximum, and its value at a very long period."""
    rise, end, top = [], [], []
    damping = 0.05
    for motion, sd in zip(
        setting.motions, setting.spectra.displacement(damping), strict=True
    ):
        ground = pgd(motion)
        peak = int(sd.argmax())
        rise.append(
            float(stats.spearmanr(PERIODS[: peak + 1], sd[: peak + 1]).statistic)
        )
        top.append(float(sd[peak]) / ground)
        # within the record: after it a residual velocity would carry the ground on for ever
        far = oscillator_response(motion, LONG, damping)[0]
        end.append(float(np.abs(far).max()) / ground)
    off = max(abs(value - 1) for value in end)
    return Result(
        Finding.FOR if min(rise) > 0.5 and off < damping else Finding.AGAINST,
        f"ρ at least {min(rise):.2f}; largest Sd {min(top):.2f} to {max(top):.2f} PGD; at {LONG:g} s Sd/PGD "
        f"{min(end):.3f} to {max(end):.3f}",
        float(np.median(end)),
        min(end),
        max(end),
        remark="estimate: median over motions of Sd/PGD at the long period; limits: range",
    )


BAND = 2 ** (1 / 3)
"""Ratio of its ends from which a range of periods is one [-]: a third of an octave, the usual band."""


def _longest_band(inside: NDArray[np.bool_]) -> tuple[float, float]:
    """Ends of the longest run of periods inside, in ratio; equal if there is none."""
    best = (1.0, 1.0)
    for flag, run in itertools.groupby(
        range(len(inside)), key=lambda k: bool(inside[k])
    ):
        members = list(run)
        ends = (float(PERIODS[members[0]]), float(PERIODS[members[-1]]))
        if flag and ends[1] / ends[0] > best[1] / best[0]:
            best = ends
    return best


@hypothesis(16, dampings=PERCENTS, ends=PERIODS[[0, -1]])
def c16(setting: Setting) -> Result:
    """Ranges of period in which Sd at 2 % and at 10 % damping are nearly the same."""
    low, high = map(setting.spectra.displacement, DAMPINGS)
    inside = np.abs(np.log(low / high)) < math.log1p(SEEN)
    bands = {
        motion.name: _longest_band(row)
        for motion, row in zip(setting.motions, inside, strict=True)
    }
    wide = {name: ends for name, ends in bands.items() if ends[1] / ends[0] >= BAND}
    shown = ", ".join(
        f"{name} {a:.2g} to {b:.2g} s" for name, (a, b) in list(wide.items())[:4]
    )
    return Result(
        Finding.FOR if wide else Finding.OPEN,
        f"motions with such a range: {len(wide)} of {len(bands)}"
        + (f": {shown}" if wide else ""),
        float(inside.mean()),
        float(inside.mean(axis=1).min()),
        float(inside.mean(axis=1).max()),
        remark="estimate: fraction of periods, mean and range over motions",
    )


@hypothesis(17, change=100 * CHANGE)
def c17(setting: Setting) -> Result:
    """Change of peak rotation with slenderness over the change of slenderness."""
    base = setting.spectra.rotation()
    change, flips = np.full((2, *base.shape), np.nan), []
    for k, factor in enumerate((1 - CHANGE, 1 + CHANGE)):
        # absolute rotations, so that the critical angle itself does not enter
        other = setting.spectra.rotation(factor) * factor
        both = np.isfinite(base) & np.isfinite(other) & (base > ROCKS) & (other > 0)
        change[k][both] = np.abs(np.log(other[both] / base[both]))
        flips.append(float((np.isfinite(base) != np.isfinite(other)).mean()))
    by_motion = np.moveaxis(change, 2, 0).reshape(len(setting.motions), -1)
    by_motion = by_motion[np.isfinite(by_motion).any(axis=1)]
    if not by_motion.size:
        raise Undecidable("no block rocks by more than 1 % of its critical angle")
    ratio = np.nanmedian(by_motion, axis=1) / CHANGE
    more = int((ratio > 1).sum())
    damping = setting.spectra.displacement(
        0.05 * (1 + CHANGE)
    ) / setting.spectra.displacement(0.05)
    return Result(
        most(more, ratio.size),
        f"motions: {more} of {ratio.size}; rotation changes {np.median(ratio):.1f} times as much as "
        f"slenderness (median; {ratio.min():.1f} to {ratio.max():.1f}), {100 * np.mean(flips):.1f} % of the "
        f"outcomes "
        f"flip; Sd changes {np.median(np.abs(np.log(damping))) / CHANGE:.2f} times as much as damping",
        float(np.median(ratio)),
        float(ratio.min()),
        float(ratio.max()),
        remark="limits: range over motions",
    )


def _order(spectrum: Floats, other: Floats) -> int:
    """1 if a spectrum exceeds the other over more abscissas than it is exceeded, -1 if over fewer, else 0."""
    more, fewer = (spectrum > other).sum(dtype=int), (spectrum < other).sum(dtype=int)
    return int(np.sign(more - fewer))


def exchanges(values: Floats, other: Floats) -> tuple[int, int]:
    """How many pairs of motions change their order between two sets of spectra, shape (motions, abscissas) each.

    A spectrum exceeds another if it does so over more than half of the abscissas at which they differ. Returns the
    number of pairs that are ordered the other way, and of pairs that are ordered in both.
    """
    changed = total = 0
    for i, j in itertools.combinations(range(len(values)), 2):
        first, second = _order(values[i], values[j]), _order(other[i], other[j])
        if first and second:
            total += 1
            changed += bool(first != second)
    return changed, total


@hypothesis(18, dampings=PERCENTS)
def c18(setting: Setting) -> Result:
    """Order of the motions' spectra at two dampings, and at two slendernesses."""
    if len(setting.motions) < 2:
        raise Undecidable("spectra are compared between motions, and there is one only")
    low, high = map(setting.spectra.displacement, DAMPINGS)
    changed, total = exchanges(low, high)
    rotation = setting.spectra.rotation()
    blocks = [
        exchanges(first, other) for first, other in itertools.combinations(rotation, 2)
    ]
    exchanged, compared = (
        (sum(counts) for counts in zip(*blocks, strict=True)) if blocks else (0, 0)
    )
    if not total or not compared:
        raise Undecidable("too few spectra can be ordered")
    oscillators, rocking = changed / total, exchanged / compared
    return Result(
        decided(rocking > oscillators, rocking < oscillators),
        f"{exchanged} of {compared} pairs of rocking spectra change their order with slenderness, {changed} "
        f"of {total} pairs of oscillator spectra with damping",
        rocking - oscillators,
    )


AMPLITUDES_G = np.geomspace(0.05, 2.0, 150)
"""2.5 % steps in which the least overturning amplitude is sought (C19)."""


def dispersion_ratio(measure: Floats, other: Floats, groups: list[str]) -> Estimate:
    """Ln of the scatter of one measure at overturning over that of another, by jackknife over groups.

    A measure is the better proxy the less it scatters from motion to motion when the block falls. Both are
    logarithms of shape (blocks, motions), NaN where it did not; motions of one earthquake, a group, are left out
    together.
    """
    names = sorted(set(groups))

    def ratio(kept: NDArray[np.bool_]) -> float:
        spread = [
            np.log(np.nanstd(first[kept], ddof=1) / np.nanstd(two[kept], ddof=1))
            for first, two in zip(measure, other, strict=True)
            if np.isfinite(first[kept]).sum() > 1
        ]
        return float(np.mean(spread)) if spread else math.nan

    member = np.array(groups)
    whole = ratio(np.ones(len(groups), dtype=bool))
    return jackknife(whole, [ratio(member != name) for name in names])


@hypothesis(19)
def c19(setting: Setting) -> Result:
    """How much Sa, PGA and PGV scatter when a block overturns."""
    motions, blocks = setting.motions, list(setting.blocks.values())
    groups = [str(motion.metadata.get("earthquake", motion.name)) for motion in motions]
    if len(set(groups)) < 3:
        raise Undecidable("there are fewer than three earthquakes")
    peak = np.array([motion.pga for motion in motions])
    scales = AMPLITUDES_G * GRAVITY / peak[:, np.newaxis]
    fell = overturns(blocks, motions, scales=scales, threads=setting.threads).overturned
    falls = fell.any(axis=2)
    pga = np.where(falls, np.log(AMPLITUDES_G[fell.argmax(axis=2)]), np.nan)
    if (falls.sum(axis=1) < 3).all():
        raise Undecidable("no block overturns under three motions at these amplitudes")
    sa = np.log(
        [spectrum.pseudo_acceleration for spectrum in setting.spectra.oscillator(0.05)]
    )
    periods = np.log([2 * math.pi / block.frequency() for block in blocks])
    own = np.column_stack([np.interp(periods, np.log(PERIODS), row) for row in sa])
    at_sa = pga + own - np.log(peak)
    at_pgv = pga + np.log([pgv(motion) for motion in motions]) - np.log(peak)
    others = {"PGA": pga, "PGV": at_pgv}
    found = {
        name: dispersion_ratio(at_sa, other, groups) for name, other in others.items()
    }
    p_more = min(known(ratio.p_above(0.0)) for ratio in found.values())
    p_less = max(known(ratio.p_below(0.0)) for ratio in found.values())
    spread = {
        name: float(np.nanmean(np.nanstd(values, axis=1, ddof=1)))
        for name, values in {**others, "Sa(2π/p)": at_sa}.items()
    }
    return Result(
        finding_of(p_more, p_less),
        "standard deviation of ln at overturning: "
        + ", ".join(f"{name} {value:.2f}" for name, value in spread.items())
        + "; Sa over "
        + ", ".join(f"{name} {ratio.text()}" for name, ratio in found.items()),
        *ratios(max(found.values(), key=lambda ratio: ratio.mean)),
        remark=f"motions: {len(motions)} of {len(set(groups))} earthquakes; mean over "
        f"blocks ({len(blocks)} of them), each over the motions that overturned it",
    )
