"""C14 to C19: response spectra and rocking spectra of the ground motions."""

import itertools
import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import stats

from rockfrag.motions.intensity import pgd, pgv
from rockfrag.motions.spectra import oscillator_response, response_spectrum
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.rocking.spectra import rocking_spectrum
from rockfrag.thesis.statements.evidence import Undecidable
from rockfrag.thesis.statements.ledger import ClaimResult
from rockfrag.thesis.statements.theory_setting import Floats, Setting

SIZES = np.geomspace(1.0, 8.0, 80)
"""2π/p of the blocks of a rocking spectrum [s]: heights from 0.4 to 24 m."""
PERIODS = np.geomspace(0.1, 10.0, 60)
"""Periods of the oscillators [s]."""
DAMPINGS = (0.02, 0.05, 0.10)
LONG = 200.0
"""A period that counts as infinite [s]."""
ROCKS = 0.01
"""Rotation below which a block hardly rocks and its spectrum has no shape, of the critical angle [-]."""
INSENSITIVE = 1.1
"""Displacements at 2 % and 10 % damping within this factor hardly depend on damping [-]."""
BAND = 1.2
"""Ratio of its ends above which a range of periods is one [-]."""
CHANGE = 0.05
"""Slightly different slenderness [-]."""
SCALES = np.geomspace(0.2, 4.0, 60)


def _slenderness(setting: Setting) -> Floats:
    return np.array(sorted(block.alpha for block in setting.blocks.values()))


def _rotation(setting: Setting, motion: Motion, alpha: Floats) -> Floats:
    return rocking_spectrum(motion, SIZES, alpha, threads=setting.threads).rotation


@lru_cache(maxsize=256)
def _displacement(samples: bytes, dt: float, damping: float) -> Floats:
    motion = Motion(np.frombuffer(samples), dt)
    return response_spectrum(motion, PERIODS, damping).displacement


def _sd(motion: Motion, damping: float) -> Floats:
    return _displacement(motion.acceleration.tobytes(), motion.dt, damping)


def c14(setting: Setting) -> ClaimResult:
    """Rank correlation of peak rotation with 2π/p, and share of steps that rise."""
    correlations, rises = [], []
    for motion in setting.motions:
        for row in _rotation(setting, motion, _slenderness(setting)):
            # a block that overturned has the largest rotation of all
            if np.nanmax(row) < ROCKS or np.unique(row).size < 10:
                continue
            correlations.append(float(stats.spearmanr(SIZES, row).statistic))
            finite = row[np.isfinite(row)]
            rises.append(float((np.diff(finite) > 0).mean()))
    if not correlations:
        raise Undecidable("no block rocks by more than 1 % of its critical angle")
    worst, share = max(correlations), max(rises)
    verdict = "supported" if worst < -0.9 and share < 0.2 else "undecided"
    if worst > -0.5:
        verdict = "contradicted"
    return ClaimResult(
        14,
        f"Spearman's correlation of max |θ|/θc with 2π/p over {SIZES.size} blocks from "
        f"{SIZES[0]:g} to {SIZES[-1]:g} s of each specimen's slenderness, motions as recorded; "
        "nearly monotonic: below -0.9 in all, with fewer than 20 % rising steps",
        f"{len(correlations)} spectra: ρ from {min(correlations):.3f} to {worst:.3f}; rising steps "
        f"{np.mean(rises):.0%} on average, {share:.0%} at most",
        verdict,
        "simulated",
        float(np.median(correlations)),
        min(correlations),
        worst,
        remark="estimate: median; limits: range over motions and slenderness",
    )


def c15(setting: Setting) -> ClaimResult:
    """Displacement spectrum: the rise to its maximum, and its value at a very long period."""
    rise, end, top = [], [], []
    for motion in setting.motions:
        ground = pgd(motion)
        sd = _sd(motion, 0.05)
        peak = int(sd.argmax())
        rise.append(float(stats.spearmanr(PERIODS[: peak + 1], sd[: peak + 1]).statistic))
        top.append(float(sd[peak]) / ground)
        # within the record: after it a residual velocity would carry the ground on for ever
        far = oscillator_response(motion, LONG, 0.05)[0]
        end.append(float(np.abs(far).max()) / ground)
    off = max(abs(value - 1) for value in end)
    verdict = "supported" if min(rise) > 0.9 and off < 0.05 and min(top) > 1 else "contradicted"
    return ClaimResult(
        15,
        f"5 % damped Sd from {PERIODS[0]:g} s to its maximum, Spearman's correlation with the period; "
        f"Sd at {LONG:g} s within the record over PGD",
        f"correlation at least {min(rise):.2f}; largest Sd {min(top):.2f} to {max(top):.2f} PGD; at "
        f"{LONG:g} s Sd/PGD {min(end):.3f} to {max(end):.3f}",
        verdict,
        "simulated",
        float(np.median(end)),
        min(end),
        max(end),
        remark="estimate: median over motions of Sd/PGD at the long period; limits: range",
    )


def _longest_band(inside: NDArray[np.bool_]) -> tuple[float, float]:
    """Ends of the longest run of periods inside, in ratio; equal if there is none."""
    best = (1.0, 1.0)
    for flag, run in itertools.groupby(range(len(inside)), key=lambda k: bool(inside[k])):
        members = list(run)
        ends = (float(PERIODS[members[0]]), float(PERIODS[members[-1]]))
        if flag and ends[1] / ends[0] > best[1] / best[0]:
            best = ends
    return best


def c16(setting: Setting) -> ClaimResult:
    """Ranges of period in which Sd at 2 % and at 10 % damping are nearly the same."""
    bands, share = {}, []
    for motion in setting.motions:
        ratio = _sd(motion, DAMPINGS[0]) / _sd(motion, DAMPINGS[-1])
        inside = (ratio < INSENSITIVE) & (ratio > 1 / INSENSITIVE)
        bands[motion.name] = _longest_band(inside)
        share.append(float(inside.mean()))
    wide = [high / low >= BAND for low, high in bands.values()]
    verdict = "supported" if all(wide) else "undecided" if any(wide) else "contradicted"
    return ClaimResult(
        16,
        f"ranges of period between {PERIODS[0]:g} and {PERIODS[-1]:g} s, their ends {BAND} or more "
        f"apart in ratio, in which Sd at 2 % and 10 % damping are within a factor {INSENSITIVE}",
        "; ".join(
            f"{name} {low:.2g} to {high:.2g} s" if high / low >= BAND else f"{name} none"
            for name, (low, high) in bands.items()
        ),
        verdict,
        "simulated",
        float(np.mean(share)),
        min(share),
        max(share),
        remark="the longest range of each motion; estimate: share of periods, mean and range",
    )


def c17(setting: Setting) -> ClaimResult:
    """Change of peak rotation with slenderness against that of Sd with damping."""
    alpha = _slenderness(setting)
    rocking, flips = [], []
    for motion in setting.motions:
        base = _rotation(setting, motion, alpha)
        for factor in (1 - CHANGE, 1 + CHANGE):
            # absolute rotations, so that the critical angle itself does not enter
            other = _rotation(setting, motion, alpha * factor) * factor
            both = np.isfinite(base) & np.isfinite(other) & (base > ROCKS) & (other > 0)
            rocking.extend(np.abs(np.log(other[both] / base[both])).tolist())
            flips.append(float((np.isfinite(base) != np.isfinite(other)).mean()))
    if not rocking:
        raise Undecidable("no block rocks by more than 1 % of its critical angle")
    oscillator = []
    for motion in setting.motions:
        for factor in (1 - CHANGE, 1 + CHANGE):
            ratio = _sd(motion, 0.05 * factor) / _sd(motion, 0.05)
            oscillator.extend(np.abs(np.log(ratio)).tolist())
    lower, middle, upper = np.quantile(rocking, [0.25, 0.5, 0.75])
    verdict = "supported" if lower > CHANGE else "contradicted" if upper < CHANGE else "undecided"
    return ClaimResult(
        17,
        f"|change of ln max |θ|| when slenderness changes by ±{CHANGE:.0%}, over blocks and motions, "
        "quartiles; very sensitive: the lower one above the change itself; beside it that of Sd when "
        f"damping changes from 5 % by ±{CHANGE:.0%}",
        f"rotation changes by {math.expm1(middle):.0%} (quartiles {math.expm1(lower):.0%}, "
        f"{math.expm1(upper):.0%}), {np.mean(flips):.1%} of the verdicts flip; Sd changes by "
        f"{math.expm1(float(np.median(oscillator))):.1%}",
        verdict,
        "simulated",
        float(middle),
        float(lower),
        float(upper),
    )


def _discordance(one: Floats, other: Floats) -> tuple[float, int]:
    """Share of (pair of motions, abscissa) whose order differs between two sets of spectra.

    Parameters
    ----------
    one, other
        Ordinates, shape (motions, abscissas).  Ties in either set speak about no order.

    Returns
    -------
    The share and the number of comparisons; Kendall's τ is one minus twice the share.
    """
    changed = total = 0
    for i, j in itertools.combinations(range(len(one)), 2):
        first, second = one[i] > one[j], other[i] > other[j]
        told = (one[i] != one[j]) & (other[i] != other[j])
        total += int(told.sum())
        changed += int((first != second)[told].sum())
    return (changed / total if total else math.nan), total


def _crossings(values: Floats) -> float:
    """Crossings of two spectra, mean over the pairs."""
    found = []
    for i, j in itertools.combinations(range(len(values)), 2):
        known = np.isfinite(values[i]) & np.isfinite(values[j])
        sign = np.sign(values[i][known] - values[j][known])
        sign = sign[sign != 0]
        found.append(int((sign[1:] != sign[:-1]).sum()))
    return float(np.mean(found))


def c18(setting: Setting) -> ClaimResult:
    """Order of the motions' spectra at two dampings, and at two slendernesses."""
    motions = setting.motions
    if len(motions) < 2:
        raise Undecidable("spectra are compared between motions, and there is one only")
    linear = [np.array([_sd(motion, damping) for motion in motions]) for damping in DAMPINGS]
    oscillator, _ = _discordance(linear[0], linear[-1])
    crossings = _crossings(linear[1])
    shares, count, rocking_crossings = [], 0, []
    for alpha in _slenderness(setting):
        pair = [
            np.array([_rotation(setting, motion, np.array([a]))[0] for motion in motions])
            for a in (alpha, alpha * (1 + 2 * CHANGE))
        ]
        if max(values.max() for values in pair) < ROCKS:
            continue
        share, n = _discordance(*pair)
        if n:
            shares.append(share)
            count += n
            rocking_crossings.append(_crossings(pair[0]))
    if not shares:
        raise Undecidable("too few blocks rock to be ordered")
    rocking = float(np.mean(shares))
    verdict = "undecided"
    if oscillator < 0.1 and min(shares) > 0:
        verdict = "supported"
    elif oscillator >= 0.25 or max(shares) == 0:
        verdict = "contradicted"
    return ClaimResult(
        18,
        "share of (pair of motions, abscissa) whose order changes, Sd from 2 % to 10 % damping against "
        f"max |θ| /θc from each specimen's slenderness to one {2 * CHANGE:.0%} less; supported if the "
        "first is below 10 % (few local exceptions) and the second is not zero for any slenderness",
        f"oscillators {oscillator:.1%} (Kendall's τ {1 - 2 * oscillator:.2f}, {crossings:.1f} crossings per "
        f"pair), blocks {rocking:.1%} (τ {1 - 2 * rocking:.2f}, {np.mean(rocking_crossings):.1f} "
        f"crossings; {count} comparisons)",
        verdict,
        "simulated",
        rocking - oscillator,
        min(shares) - oscillator,
        max(shares) - oscillator,
        remark="estimate: difference of the shares; limits: range over slenderness; a block that "
        "overturns under both motions orders nothing",
    )


def _auc(measure: Floats, overturned: NDArray[np.bool_]) -> float:
    """Probability that an overturning case has the larger measure (ties count half) [-]."""
    ranks = stats.rankdata(measure)
    n1 = int(overturned.sum())
    n0 = overturned.size - n1
    if not n1 or not n0:
        return math.nan
    return float((ranks[overturned].sum() - n1 * (n1 + 1) / 2) / (n0 * n1))


def c19(setting: Setting) -> ClaimResult:
    """How well spectral ordinates tell overturning from standing, against PGA and PGV."""
    motions, blocks = setting.motions, list(setting.blocks.values())
    if len(motions) < 3:
        raise Undecidable("fewer than three motions")
    verdicts = overturns(
        blocks,
        [one.acceleration for one in motions],
        [one.dt for one in motions],
        SCALES,
        threads=setting.threads,
    ).overturned
    sa = np.array([response_spectrum(one, PERIODS, 0.05).pseudo_acceleration for one in motions])
    own = [
        np.exp(
            [
                np.interp(math.log(2 * math.pi / block.frequency()), np.log(PERIODS), np.log(row))
                for row in sa
            ]
        )
        for block in blocks
    ]
    peak = {
        "PGA": np.array([one.pga for one in motions]),
        "PGV": np.array([pgv(one) for one in motions]),
    }

    def score(unit: list[Floats], chosen: list[int]) -> float:
        """Mean over the blocks of the AUC of a measure per unit scale, by block."""
        found = [
            _auc((unit[b][chosen, np.newaxis] * SCALES).ravel(), verdicts[b][chosen].ravel())
            for b in range(len(blocks))
        ]
        return float(np.nanmean(found)) if np.isfinite(found).any() else math.nan

    def scores(chosen: list[int]) -> dict[str, float]:
        found = {name: score([unit] * len(blocks), chosen) for name, unit in peak.items()}
        found["Sa(2π/p)"] = score(own, chosen)
        best = [score([column] * len(blocks), chosen) for column in sa.T]
        found["best Sa"] = float(np.nanmax(best))
        return found

    everyone = list(range(len(motions)))
    whole = scores(everyone)
    parts = [scores([k for k in everyone if k != left]) for left in everyone]
    if not np.isfinite(list(whole.values())).all():
        raise Undecidable("no block overturns, or all do, at these amplitudes")

    def lead(found: dict[str, float]) -> float:
        return found["Sa(2π/p)"] - max(found["PGA"], found["PGV"])

    leads = [lead(part) for part in parts]
    verdict = "undecided"
    if max(*leads, lead(whole)) < 0:
        verdict = "supported"
    elif min(*leads, lead(whole)) > 0:
        verdict = "contradicted"
    return ClaimResult(
        19,
        "area under the ROC curve of Sa (5 %) at T = 2π/p of the block, of PGA and of PGV for the "
        f"verdicts of each lone block under the motions × {SCALES.size} scales from {SCALES[0]:g} to "
        f"{SCALES[-1]:g}, mean over blocks; supported if Sa is behind the better of the two also when "
        "any one motion is left out",
        ", ".join(f"{name} {value:.3f}" for name, value in whole.items()),
        verdict,
        "simulated",
        lead(whole),
        min(leads),
        max(leads),
        remark=f"estimate: area of Sa(2π/p) minus the better of PGA and PGV; limits: range with one of "
        f"{len(motions)} motions left out; best Sa is the best of {PERIODS.size} periods, chosen "
        "afterwards, which flatters it; all areas are large because the scales range widely",
    )
