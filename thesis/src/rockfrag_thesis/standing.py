"""Which definitions of a test stand when motion and body differ a little, and which are a matter of luck."""

import math
from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from rockfrag.arrays import Flags, Floats
from rockfrag.motions.processing import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.rocking.ensemble import overturned_cases, prepared
from rockfrag.rocking.robustness import perturbed
from rockfrag.shaketable.definitions import always_overturning, first_overturning, step_protocol
from rockfrag.shaketable.protocols import Protocol
from rockfrag.system.system import System

SIZES = (1e-9, 1e-6, 1e-4)
"""Relative differences of the motion and of every width and height, at most."""

COPIES = 4
"""Perturbed copies of a test for each of them."""

Bounds = tuple[float, float]
Copy = tuple[System, float]
"""A perturbed system and the factor on its motion."""

CLIMBING = ("step_protocol", "first_overturning")
"""Readings that see nothing above the amplitude at which they end."""


def standing_definitions(
    configurations: Sequence[System],
    motions: Sequence[Motion],
    amplitudes_g: Floats,
    protocol: Protocol,
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
        copies = [
            [
                (perturbed(configuration, size, rng), 1 + size * float(rng.uniform(-1, 1)))
                for _ in range(COPIES)
            ]
            for size in SIZES
        ]
        fell = overturns(configuration, motions, scales=scales, threads=threads).overturned[0]
        found = [_definitions(amplitudes_g, flags, protocol) for flags in fell]
        stands = {
            (k, i, name): True
            for k in range(len(SIZES))
            for i in range(len(motions))
            for name in found[i]
        }
        for number in range(COPIES):
            tried = [each[number] for each in copies]
            wanted = _asked(amplitudes_g, found, stands)
            ends = _outcomes(tried, motions, scales, wanted, threads)
            for k, i in np.ndindex(wanted.shape[:2]):
                # where a copy was not shaken its outcome changes no reading that is still in question
                flags = np.where(wanted[k, i], ends[k, i], fell[i])
                for name, bounds in _definitions(amplitudes_g, flags, protocol).items():
                    same = np.array_equal(bounds, found[i][name], equal_nan=True)
                    stands[k, i, name] &= same
        for i, motion in enumerate(motions):
            rows += [
                {
                    "test": f"{configuration.name} {motion.name}",
                    "configuration": configuration.name,
                    "motion": motion.name,
                    "definition": name,
                    "lower_g": bounds[0],
                    "upper_g": bounds[1],
                    **{f"stands_{size:.0e}": stands[k, i, name] for k, size in enumerate(SIZES)},
                }
                for name, bounds in found[i].items()
            ]
    return pd.DataFrame(rows)


def _definitions(amplitudes_g: Floats, flags: Flags, protocol: Protocol) -> dict[str, Bounds]:
    """Bounds by definition."""
    outcomes = {
        "step_protocol": step_protocol(amplitudes_g, flags, protocol),
        "first_overturning": first_overturning(amplitudes_g, flags),
        "always_overturning": always_overturning(amplitudes_g, flags),
    }
    return {name: (outcome.lower_g, outcome.upper_g) for name, outcome in outcomes.items()}


def _asked(
    amplitudes_g: Floats,
    found: Sequence[Mapping[str, Bounds]],
    stands: Mapping[tuple[int, int, str], bool],
) -> Flags:
    """Amplitudes that can tell whether a definition stands that does so far, shape (sizes, motions, amplitudes).

    What climbs until the first overturning does not see the amplitudes above it; the amplitude from which
    everything overturns does not see those below the last survived one.
    """
    asked = np.zeros((len(SIZES), len(found), len(amplitudes_g)), dtype=bool)
    for (k, i, name), so_far in stands.items():
        lower, upper = found[i][name]
        if not so_far:
            continue
        if name in CLIMBING:
            asked[k, i] |= amplitudes_g <= (math.inf if math.isnan(upper) else upper)
        else:
            asked[k, i] |= amplitudes_g >= lower
    return asked


def _outcomes(
    copies: Sequence[Copy], motions: Sequence[Motion], scales: Floats, wanted: Flags, threads: int
) -> Flags:
    """Whether each copy overturns in the wanted cases, shape (copies, motions, amplitudes); False elsewhere."""
    copy, motion, amplitude = np.nonzero(wanted)
    factors = np.array([factor for _, factor in copies])
    ends = np.zeros(wanted.shape, dtype=bool)
    systems = [system for system, _ in copies]
    cases = prepared(systems, motions, None, (1.0,), threads=threads)
    ends[wanted] = overturned_cases(cases, copy, motion, scales[motion, amplitude] * factors[copy])
    return ends
