"""The rules by which intervals become findings, the same for all hypotheses about tests.

Every rule reads the 95 % interval that is printed, so that a reader can apply it to the row, and errs in at most
2.5 % of tables each way (docs/hypotheses.md). That all differences are positive is an intersection-union test
(Berger 1982), which needs no adjustment.
"""

import math
from collections.abc import Sequence
from dataclasses import replace

from rockfrag.effects.cluster_means import Estimate, t_estimate
from rockfrag_thesis.hypotheses.contrasts import power_note
from rockfrag_thesis.hypotheses.hypothesis import Finding, Result

LEVEL = 0.025  # error of a rule, each way [-]: that of one end of a 95 % interval


SEEN = 0.10
"""Least mean change of overturning amplitude that the thesis's tests could show with 80 % power [-].

Four earthquakes, each with nine pairs that scatter by 0.134 through tolerances of geometry and
restitution alone, show 10 % (power of t on four earthquake means)."""


def known(p: float) -> float:
    """A p value; one unit alone has none, and shows nothing."""
    return 1.0 if math.isnan(p) else p


def p_nonzero(estimate: Estimate) -> float:
    """Two-sided p value of a mean of zero; 1 if unknown."""
    return 2 * min(known(estimate.p_above(0.0)), known(estimate.p_below(0.0)))


def finding_of(p_for: float, p_against: float) -> Finding:
    """Finding from the one-sided p values of a hypothesis's being false and of its being true."""
    return decided(p_for < LEVEL, p_against < LEVEL)


def same(
    estimate: Estimate,
    figure: str,
    *,
    bound: float = SEEN,
    unit: str = "earthquake",
    more: str = "",
) -> Result:
    """Judge "nearly equal" or "not correlated": a log ratio [-] within ±ln(1 + bound).

    ``figure`` is the result in words, ``unit`` what was sampled, for the note on power.
    """
    limit = math.log1p(bound)
    inside = max(known(estimate.p_above(-limit)), known(estimate.p_below(limit)))
    outside = min(known(estimate.p_above(limit)), known(estimate.p_below(-limit)))
    finding = finding_of(inside, outside)
    notes = [more] if more else []
    if finding is Finding.OPEN:
        notes.append(power_note(estimate, unit))
    return Result(
        finding,
        figure,
        *ratios(estimate),
        p=min(1.0, 2 * min(inside, outside)),
        # the hypothesis whose p value is the smaller one
        p_of=f"a difference {'of' if inside <= outside else 'below'} {100 * bound:g} %"
        f"{' or more' if inside <= outside else ''}",
        remark="; ".join(notes),
    )


def jackknife(whole: float, without: Sequence[float]) -> Estimate:
    """Figure of all data with its t interval from what it is without each earthquake in turn, shape (k,).

    It is centred on ``whole``, with the standard error of Tukey's k pseudovalues (1958) and k - 1 degrees of
    freedom; a figure that is not finite is a TooFewUnitsError.
    """
    k = len(without)
    pseudo = t_estimate([k * whole - (k - 1) * fewer for fewer in without])
    half = (pseudo.upper - pseudo.lower) / 2
    zero = Estimate(whole, pseudo.se, k, whole - half, whole + half, math.nan)
    return replace(zero, p=2 * min(zero.p_above(0.0), zero.p_below(0.0)))


def decided(so: bool, not_so: bool) -> Finding:
    """Finding on a hypothesis that some figures show to be so, and others not to be; open where none does."""
    if so:
        return Finding.FOR
    return Finding.AGAINST if not_so else Finding.OPEN


def ratios(estimate: Estimate) -> tuple[float, float, float]:
    """An estimate of a log ratio and its limits as ratios [-]."""
    return estimate.ratio, estimate.ratio_lower, estimate.ratio_upper


def most(count: int, total: int) -> Finding:
    """Finding on "usually", "nearly": true for more than half of the cases looked at; not inference."""
    return Finding.FOR if count > total / 2 else Finding.AGAINST


def all_of(*findings: Finding) -> Finding:
    """Finding on a conjunction: one against suffices, support needs all."""
    against = Finding.AGAINST in findings
    return decided(not against and set(findings) == {Finding.FOR}, against)
