"""Which definitions of a test stand when motion and body differ a little, and which are a matter of luck."""

import warnings
from collections.abc import Sequence

import numpy as np
import pandas as pd

from rockfrag.base.arrays import Flags, Floats
from rockfrag.motions.processing import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.shaketable.definitions import (
    always_overturning,
    first_overturning,
    step_protocol,
)
from rockfrag.shaketable.protocols import Protocol
from rockfrag.simulation import overturns
from rockfrag.simulation.ensemble import LightBodies
from rockfrag.simulation.robustness import perturbed
from rockfrag.system.system import System

SIZES = (1e-9, 1e-6, 1e-4)
"""Relative differences of the motion and of every width and height, at most."""

COPIES = 4  # perturbed copies of a test for each of them


def standing_definitions(
    configurations: Sequence[System],
    motions: Sequence[Motion],
    amplitudes_g: Floats,
    protocol: Protocol,
    *,
    seed: int,
    threads: int = 1,
) -> pd.DataFrame:
    """Read every IDA curve again with perturbed copies of motion and body, drawn by ``seed``.

    ``amplitudes_g`` are the peaks of the IDA curve [g], rising.

    Returns one row per test and reading: ``test``, ``configuration``, ``motion``, ``definition``, ``lower_g``,
    ``upper_g`` (bounds of the amplitude [g]; NaN above if it never overturned), and for each of `SIZES`
    ``stands_1e-09`` and so on: whether every copy has the same bounds.
    """
    scales = np.array([factors_to_pga(motion, amplitudes_g) for motion in motions])
    rng = np.random.default_rng(seed)
    rows = []
    for configuration in configurations:
        fell = overturns(configuration, motions, scales=scales, threads=threads)
        found = [
            _definitions(amplitudes_g, flags, protocol) for flags in fell.overturned[0]
        ]
        stands = {
            (size, i, name): True
            for size in SIZES
            for i, bounds in enumerate(found)
            for name in bounds
        }
        for size in np.repeat(SIZES, COPIES).tolist():
            copy = perturbed(configuration, size, rng)
            factor = 1 + size * float(rng.uniform(-1, 1))
            with warnings.catch_warnings():
                # of what is said of the test itself nothing is said again of its copies
                warnings.simplefilter("ignore", LightBodies)
                fell = overturns(copy, motions, scales=scales * factor, threads=threads)
            for i, flags in enumerate(fell.overturned[0]):
                for name, bounds in _definitions(amplitudes_g, flags, protocol).items():
                    stands[size, i, name] &= np.array_equal(
                        bounds, found[i][name], equal_nan=True
                    )
        for i, motion in enumerate(motions):
            rows += [
                {
                    "test": f"{configuration.name} {motion.name}",
                    "configuration": configuration.name,
                    "motion": motion.name,
                    "definition": name,
                    "lower_g": bounds[0],
                    "upper_g": bounds[1],
                    **{f"stands_{size:.0e}": stands[size, i, name] for size in SIZES},
                }
                for name, bounds in found[i].items()
            ]
    return pd.DataFrame(rows)


def _definitions(
    amplitudes_g: Floats, flags: Flags, protocol: Protocol
) -> dict[str, tuple[float, float]]:
    """Bounds by definition."""
    outcomes = {
        "step_protocol": step_protocol(amplitudes_g, flags, protocol),
        "first_overturning": first_overturning(amplitudes_g, flags),
        "always_overturning": always_overturning(amplitudes_g, flags),
    }
    return {
        name: (outcome.lower_g, outcome.upper_g) for name, outcome in outcomes.items()
    }
