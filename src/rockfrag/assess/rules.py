"""What engineers' rules are worth: held against simulations, object by object and motion by motion.

Each rule gives the factor on a motion at which it expects a symmetric block that stands alone to topple; an object
on a pedestal is looked at twice, as practice does: itself, and both as one body.
"""

import math
import os
from collections.abc import Callable
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
from rockfrag.base.units import GRAVITY
from rockfrag.base.yaml_file import read_yaml
from rockfrag.config.schema import checked
from rockfrag.motions.intensity import pgv
from rockfrag.motions.response_spectra import response_spectrum
from rockfrag.records.motion import Motion
from rockfrag.runtime.progress import Progress
from rockfrag.simulation.closed_forms import housner_velocity
from rockfrag.system.blocks import Block

HOUSNER_PERIODS = np.linspace(0.1, 2.5, 25)
"""Periods of the velocity spectrum over which Housner's rule takes a mean, those of his intensity [s]."""

ANGLES = np.linspace(0.02, 1.0, 40)
"""Rotations over the critical angle at which ASCE 43-05 compares capacity with demand."""

Rule = Callable[[Block, Motion], float]


def static(block: Block, motion: Motion) -> float:
    """Factor at which the peak acceleration reaches b/h: what starts rocking is taken to topple."""
    return float(GRAVITY * math.tan(block.alpha) / motion.pga)


def housner(block: Block, motion: Motion) -> float:
    """Factor at which half of all motions topple the block by their velocity spectrum (Housner, 1963).

    The critical angle is Sv √(m R² / (g R I_O)), that is Sv = g α / p. Sv is the mean of the undamped
    pseudo-velocity spectrum from 0.1 to 2.5 s.
    """
    spectrum = response_spectrum(motion, HOUSNER_PERIODS, 0.0).pseudo_velocity
    return float(housner_velocity(block.alpha, block.frequency()) / spectrum.mean())


def peak_velocity(block: Block, motion: Motion) -> float:
    """Factor at which the peak velocity reaches g α / p, Housner's velocity read as that of the floor."""
    return float(housner_velocity(block.alpha, block.frequency()) / pgv(motion))


def asce_43(block: Block, motion: Motion) -> float:
    """Factor at which the spectrum exceeds the capacity at every rotation up to the critical one (ASCE 43-05, A).

    A rocking block is taken for an oscillator: at the rotation θ it has the effective frequency
    √(2 (f - 1) g / (C h)) / (2π θ) with f = cos θ + a sin θ, a = b/h, C = (4/3) (1 + a²), the damping
    γ / √(4π² + γ²) with γ = -2 ln(1 - 2a²/C), and bears the spectral acceleration 2 g (f - 1) / θ, here without
    vertical shaking. The block topples where no rotation bears the demand.
    """
    a = math.tan(block.alpha)
    inertia = 4 / 3 * (1 + a**2)
    decrement = -2 * math.log(max(1 - 2 * a**2 / inertia, 1e-6))
    damping = decrement / math.sqrt(4 * math.pi**2 + decrement**2)
    theta = ANGLES * block.alpha
    lifted = np.cos(theta) + a * np.sin(theta) - 1
    frequency = np.sqrt(2 * lifted * GRAVITY / (inertia * block.h)) / (
        2 * math.pi * theta
    )
    capacity = 2 * GRAVITY * lifted / theta
    demand = response_spectrum(motion, 1 / frequency, damping).pseudo_acceleration
    return float((capacity / demand).max())


RULES: dict[str, Rule] = {
    "static b/h": static,
    "Housner 1963": housner,
    "peak velocity": peak_velocity,
    "ASCE 43-05 A": asce_43,
}
"""Rules by name."""


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
    simulated = np.where(first >= 0, scales, np.nan)
    known = np.isfinite(simulated)
    models, found = {objects.body.blocks[-1], objects.body.rigidly_joined()}, []
    for name, rule in RULES.items():
        # the least of the models of practice
        least = [
            min(rule(block, motion) for block in models) for motion in motions.base
        ]
        factors = np.array(least)
        ratio = pd.Series(np.log(factors / simulated)[known])
        unsafe = float(pd.Series((factors > simulated)[known]).mean())
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
