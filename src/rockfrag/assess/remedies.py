"""What helps: the object changed, shaken by the same motions, as a factor on the probability."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats

from rockfrag.assess.objects import Objects, higher, wider
from rockfrag.assess.risk import LEVEL, Target, event_weights
from rockfrag.assess.verdicts import Verdicts
from rockfrag.system.blocks import Body, Stack

WIDER = 1.25
"""Factor of a wider base."""

LOWER = 0.8
"""Factor of a lower centre of gravity."""


@dataclass(frozen=True)
class Remedy:
    """What a change does.

    Attributes
    ----------
    name
        What is changed, in words.
    value
        The probability, share or amplitude with it.
    factor
        That over the one without it [-]; 0 where no motion topples the object any more.
    lower, upper
        Limits of the factor, of the same motions with and without it; NaN where there are none.
    helps
        Whether the object is better off with it: what is estimated shrinks, or an amplitude grows.
    """

    name: str
    value: float
    factor: float
    lower: float
    upper: float
    helps: bool


def remedies_of(objects: Objects) -> dict[str, Body]:
    """Bodies that result from each change.

    Parameters
    ----------
    objects
        The object as it is.
    """
    statue, pedestal = objects.statue, objects.pedestal
    more, less = f"{100 * (WIDER - 1):.0f} % wider", f"{100 * (1 - LOWER):.0f} % lower"
    if pedestal is None:
        return {
            f"a base {more}": wider(statue, WIDER),
            f"a centre of gravity {less}": higher(statue, LOWER),
        }
    stack = Stack(pedestal, statue)
    found: dict[str, Body] = {
        f"a base {more} under the pedestal": Stack(wider(pedestal, WIDER), statue)
    }
    if WIDER * statue.width <= pedestal.width:
        # beyond the pedestal's edges a wider base carries no further out
        found[f"a base {more} under the object"] = Stack(pedestal, wider(statue, WIDER))
    return found | {
        f"a centre of gravity {less}": Stack(pedestal, higher(statue, LOWER)),
        "fixing the object to its pedestal": stack.rigidly_joined(),
        "fixing the pedestal to the floor": statue,
    }


def compare(target: Target, now: Verdicts, changed: Mapping[str, Verdicts]) -> list[Remedy]:
    """Factors of changes on what is estimated, the most helpful first.

    Parameters
    ----------
    target
        What is estimated.
    now
        Verdicts of the object as it is.
    changed
        Verdicts with each change.
    """
    found = [_remedy(target, name, now, one) for name, one in changed.items()]
    found.sort(key=lambda remedy: remedy.value)
    return found


def _remedy(target: Target, name: str, now: Verdicts, one: Verdicts) -> Remedy:
    before, after = target.value(now), target.value(one)
    helps = after > before if math.isinf(target.certain) else after < before
    if not (math.isfinite(before) and before > 0 and math.isfinite(after)):
        return Remedy(name, after, math.nan, math.nan, math.nan, helps)
    factor = after / before
    limits = _limits(target, now, one, factor)
    return Remedy(name, after, factor, *limits, helps)


def _limits(target: Target, now: Verdicts, one: Verdicts, factor: float) -> tuple[float, float]:
    """Limits of a factor by a jackknife over earthquakes; NaN where one of them decides alone."""
    weights = event_weights(now.events)
    groups = len(weights)
    pairs = np.array([[target.value(v, w) for v in (one, now)] for w in weights])
    if groups < 2 or not np.isfinite(pairs).all() or (pairs <= 0).any():
        return math.nan, math.nan
    ratios = np.log(pairs[:, 0] / pairs[:, 1])
    error = np.sqrt((groups - 1) / groups * ((ratios - ratios.mean()) ** 2).sum())
    half = float(stats.t.ppf(0.5 + LEVEL / 2, groups - 1) * error)
    return factor * math.exp(-half), factor * math.exp(half)


def without_simulation() -> list[str]:
    """What is named but not simulated, each in a sentence."""
    return [
        "Fixing everything to the floor ends rocking; its anchors then carry the whole inertia.",
        "Base isolation helps against fast shaking and little against slow pulses; it needs a design of its own "
        "and is not simulated here.",
    ]
