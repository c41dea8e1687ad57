"""What survival says about the hazard of a site: weights, curves, which object decides, and what it hangs on."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from rockfrag.errors import InputError
from rockfrag.survival.reweight import Reweighted, reweight, scaled
from rockfrag.survival.site import Site

LEAST_SURVIVAL = 1e-9
"""Probability that all objects stand below which, in every branch, hazard, fragility or age must be wrong."""

RULED_OUT = 0.01
"""A branch whose weight falls below this fraction of what it was counts as ruled out."""

IN_SPACE = 0.84
"""Median of toppling of boxes under two horizontal components over that of planar rocking under one [-]; see
``docs/space.md``.  Round bases: about a half."""

LIMITS = (
    "Survival tells how strong shaking at the site has been since the objects stand, not how strong it will be "
    "in the next 50 years if rates change.",
    "The fragility is that of today; an object that was broader or lower, buried or supported was less fragile "
    "then, and counts for less: state since when with fragile_for_years.",
    "The branches are reweighted, not validated: if none of them is right, none of the new weights is.",
)
"""What a reader of reweighted hazard must know."""


@dataclass(frozen=True)
class Constrained:
    """Hazard of a site after survival, and what it hangs on.

    Ratios of levels are of the mean hazard after over before at ``DECISION_RATE``.
    """

    site: Site  #: What is known of the site
    result: Reweighted  #: Weights and curves
    #: A row an object: ``object``, ``information_bit``, ``level_ratio_alone`` and ``level_ratio_without``
    by_object: pd.DataFrame
    sensitivity: pd.DataFrame  #: A row an assumption: ``assumption`` and ``level_ratio``

    @property
    def ruled_out(self) -> list[str]:
        """Branches whose weight fell below ``RULED_OUT`` of what it was."""
        kept = self.result.weights >= RULED_OUT * self.result.prior
        return [b.name for b, stays in zip(self.site.branches, kept, strict=True) if not stays]


def constrain(site: Site) -> Constrained:
    """Reweight the branches of a site by the survival of its objects.

    Returns weights, curves, contributions of objects and sensitivities; that no branch lets all of them stand is
    an InputError.
    """
    result = reweight(site)
    if float(result.log_survival.max()) < np.log(LEAST_SURVIVAL):
        alone = {}
        for body in site.objects:
            alone[body.name] = reweight(replace(site, objects=(body,))).log_survival.max()
        worst = min(alone, key=alone.__getitem__)
        raise InputError(
            "objects: in no branch of the hazard do all of them stand with a probability above "
            f"{LEAST_SURVIVAL:g}; {worst} is most at odds with the branches: check its fragility, "
            "its age and the units of the hazard."
        )
    return Constrained(site, result, _by_object(site), _sensitivity(site))


def _by_object(site: Site) -> pd.DataFrame:
    rows = []
    for body in site.objects:
        alone = reweight(replace(site, objects=(body,)))
        others = tuple(other for other in site.objects if other is not body)
        without = reweight(replace(site, objects=others)).level_ratio if others else 1.0
        rows.append((body.name, alone.information, alone.level_ratio, without))
    columns = ["object", "information_bit", "level_ratio_alone", "level_ratio_without"]
    table = pd.DataFrame(rows, columns=columns)
    return table.sort_values("information_bit", ascending=False, ignore_index=True)


def _sensitivity(site: Site) -> pd.DataFrame:
    """Ratio of levels where one assumption at a time is another."""
    objects = site.objects
    less = f"{100 * (1 - IN_SPACE):.0f} %"
    cases = {
        "as stated": scaled(objects),
        "ages half as long": scaled(objects, age=0.5),
        "ages twice as long": scaled(objects, age=2.0),
        "objects withstand 25 % more": scaled(objects, capacity=1.25),
        "objects withstand 25 % less": scaled(objects, capacity=0.75),
        f"boxes under two components instead of one plane (withstand {less} less)": scaled(
            objects, capacity=IN_SPACE
        ),
    }
    sites = {name: replace(site, objects=moved) for name, moved in cases.items()}
    if len(objects) > 1:
        sites["errors of fragilities independent"] = replace(site, shared_error=0.0)
        sites["errors of fragilities all the same"] = replace(site, shared_error=1.0)
    rows = [(name, reweight(other).level_ratio) for name, other in sites.items()]
    return pd.DataFrame(rows, columns=["assumption", "level_ratio"])
