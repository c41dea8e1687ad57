"""What engineers' rules are worth: held against simulations, object by object and motion by motion.

Each rule gives the factor on a motion at which it expects a symmetric block that stands alone to topple; an object
on a pedestal is looked at twice, as practice does: itself, and both as one body.

In: blocks and motions. Out: factors on the motions by rule, and how far simulations are from them [-].
Theory: ``docs/rules-of-thumb.md``.
"""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.outcomes import ObjectOutcomes, make_intensity_levels
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records, make_request
from rockfrag.assess.standing import Standing
from rockfrag.base.yaml_file import read_yaml
from rockfrag.config.schema import checked
from rockfrag.runtime.progress import Progress
from rockfrag.simulation.rules_of_thumb import RULES


@dataclass(frozen=True)
class RuleCheck:
    """A rule held against simulations of one object."""

    rule: str  # Its name
    # Median of its amplitude to topple the object over the simulated one [-]
    bias: float
    scatter: float  # Standard deviation of the logarithm of that [-]
    # Fraction of the motions that topple the object at less than the rule says [-]
    unsafe: float
    motions: int  # Number of motions that topple it at all


def check_rules(
    objects: Standing, motions: MotionSet, outcomes: ObjectOutcomes
) -> list[RuleCheck]:
    """Hold every rule that applies to an object against its outcomes under the motions that shake it."""
    # least factor on each motion that topples the object; NaN where none does
    first = outcomes.first()
    scales = outcomes.intensity_levels.scales[np.arange(first.size), first]
    # a rule is held against the motions that topple the object: its spectra of the others cost seconds
    toppling = np.flatnonzero(first >= 0)
    simulated = scales[toppling]
    models, found = {objects.body.blocks[-1], objects.body.rigidly_joined()}, []
    for name, rule in RULES.items():
        # the least of the models of practice
        least = [
            min(rule(block, motions.base[motion]) for block in models)
            for motion in toppling
        ]
        factors = np.array(least)
        ratio = pd.Series(np.log(factors / simulated))
        unsafe = float(pd.Series(factors > simulated).mean())
        bias, scatter = float(np.exp(ratio.median())), float(ratio.std())
        found.append(RuleCheck(name, bias, scatter, unsafe, len(ratio)))
    return found


def rules_study(
    path: str | os.PathLike[str],
    records: str | Path,
    progress: Progress | None = None,
) -> pd.DataFrame:
    """Hold engineers' rules against simulations of the objects of a file, under the default motions.

    Parameters
    ----------
    path, records : file of the objects, and folder of fetched records
    progress : called with the number of objects done and of all

    Returns
    -------
    pandas.DataFrame: a row, a :class:`RuleCheck`, for each rule and object.
    """
    given = checked(read_yaml(path), "rules_of_thumb", str(path))
    requests = [
        make_request(object_, f"{path}, object {i}", Path(path).parent)
        for i, object_ in enumerate(given["objects"], start=1)
    ]
    motions = motion_set(Records(), Place(), Path(records))
    shaking = make_intensity_levels(motions, PGA)
    rows = []
    for done, request in enumerate(requests, start=1):
        objects = request.objects
        (outcomes,) = shaking.outcomes_of([objects])
        rows += [
            {"object": request.name, **vars(check)}
            for check in check_rules(objects, motions, outcomes)
        ]
        if progress is not None:
            progress(done, len(requests))
    return pd.DataFrame(rows)
