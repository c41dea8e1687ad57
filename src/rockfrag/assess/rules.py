"""What engineers' rules are worth: held against simulations, object by object and motion by motion."""

import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.assess.hazard.curve import PGA
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.objects import Objects
from rockfrag.assess.outcomes import ObjectOutcomes, make_intensity_levels
from rockfrag.assess.place import Place
from rockfrag.assess.request import Records, make_request
from rockfrag.rocking.rules_of_thumb import RULES, bias, predicted
from rockfrag.schema import checked
from rockfrag.yaml_file import read_yaml


@dataclass(frozen=True)
class RuleCheck:
    """A rule held against simulations of one object."""

    rule: str  # Its name
    # Median of the amplitude at which it expects a motion to topple the object over the simulated one [-]
    bias: float
    scatter: float  # Standard deviation of the logarithm of that [-]
    unsafe: float  # Fraction of the motions that topple the object at less than the rule says [-]
    motions: int  # Number of motions that topple it at all


def check_rules(objects: Objects, motions: MotionSet, outcomes: ObjectOutcomes) -> list[RuleCheck]:
    """Hold every rule that applies to an object against its outcomes under the motions that shake it."""
    # least factor on each motion that topples the object; NaN where none does
    first = outcomes.first()
    scales = outcomes.intensity_levels.scales[np.arange(first.size), first]
    simulated = np.where(first >= 0, scales, np.nan)
    found = []
    for name, rule in RULES.items():
        factors = np.array([predicted(objects.body, motion, rule) for motion in motions.base])
        middle, scatter = bias(factors, simulated)
        known = np.isfinite(simulated)
        unsafe = float((factors > simulated)[known].mean()) if known.any() else float("nan")
        found.append(RuleCheck(name, middle, scatter, unsafe, int(known.sum())))
    return found


def rules_study(path: str | os.PathLike[str], records: str | Path) -> pd.DataFrame:
    """Hold the rules against objects of a file such as ``config/rules-of-thumb.yaml`` under the default motions.

    Returns a row for each object and rule, see :class:`RuleCheck`.
    """
    given = checked(read_yaml(path), "rules_of_thumb", str(path))
    requests = [
        make_request(object_, f"{path}, object {i}", Path(path).parent)
        for i, object_ in enumerate(given["objects"], start=1)
    ]
    motions = motion_set(Records(), Place(), Path(records))
    shaking = make_intensity_levels(motions, PGA)
    rows = []
    for request in requests:
        objects = request.objects
        (outcomes,) = shaking.outcomes_of([objects])
        rows += [
            {"object": request.name, **vars(check)}
            for check in check_rules(objects, motions, outcomes)
        ]
    return pd.DataFrame(rows)
