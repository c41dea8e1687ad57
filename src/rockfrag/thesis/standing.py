"""Which readings of a test stand when motion and body differ a little, and which are a matter of luck."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.motions.scaling import factors_to_pga
from rockfrag.records.motion import Motion
from rockfrag.rocking import overturns
from rockfrag.rocking.sureness import perturbed
from rockfrag.shaketable.protocols import Protocol
from rockfrag.shaketable.readings import always_overturning, first_overturning, step_protocol
from rockfrag.study.configurations import Configuration

SIZES = (1e-9, 1e-6, 1e-4)
"""Relative differences of the motion and of every width and height, at most."""

COPIES = 4
"""Perturbed copies of a test for each of them."""

Bounds = tuple[float, float]


def standing_readings(
    configurations: Sequence[Configuration],
    motions: Sequence[Motion],
    amplitudes_g: NDArray[np.float64],
    protocol: Protocol,
    seed: int,
    threads: int = 1,
) -> pd.DataFrame:
    """Read every sweep again with perturbed copies of motion and body.

    Parameters
    ----------
    configurations, motions
        What was tested, and with what.
    amplitudes_g
        Peaks of the sweep [g], rising.
    protocol
        Protocol of the laboratory.
    seed
        Seed of the perturbations.
    threads
        Threads to use; the result does not depend on it.

    Returns
    -------
    One row per test and reading: ``test``, ``configuration``, ``motion``, ``reading``, ``lower_g``,
    ``upper_g`` (bounds of the amplitude [g]; NaN above if it never overturned), and for each of `SIZES`
    ``stands_1e-09`` and so on: whether every copy has the same bounds.
    """
    scales = np.array([factors_to_pga(motion, amplitudes_g) for motion in motions])
    rng = np.random.default_rng(seed)

    def read(configuration: Configuration, size: float) -> Iterator[dict[str, Bounds]]:
        """Bounds by reading for each motion, of a copy that differs by up to ``size``."""
        body = configuration.body if size == 0 else perturbed(configuration.body, size, rng)
        fell = overturns(
            [body],
            [motion.acceleration for motion in motions],
            [motion.dt for motion in motions],
            scales * (1 + size * float(rng.uniform(-1, 1))),
            restitution=[configuration.restitution],
            threads=threads,
        ).overturned[0]
        for verdicts in fell:
            outcomes = {
                "step_protocol": step_protocol(amplitudes_g, verdicts, protocol),
                "first_overturning": first_overturning(amplitudes_g, verdicts),
                "always_overturning": always_overturning(amplitudes_g, verdicts),
            }
            yield {name: (one.lower_g, one.upper_g) for name, one in outcomes.items()}

    rows = []
    for configuration in configurations:
        found = list(read(configuration, 0.0))
        copies = {size: [list(read(configuration, size)) for _ in range(COPIES)] for size in SIZES}
        for i, motion in enumerate(motions):
            for reading, bounds in found[i].items():
                stands = {
                    f"stands_{size:.0e}": all(
                        _same(copy[i][reading], bounds) for copy in copies[size]
                    )
                    for size in SIZES
                }
                rows.append(
                    {
                        "test": f"{configuration.name} {motion.name}",
                        "configuration": configuration.name,
                        "motion": motion.name,
                        "reading": reading,
                        "lower_g": bounds[0],
                        "upper_g": bounds[1],
                        **stands,
                    }
                )
    return pd.DataFrame(rows)


def _same(one: Bounds, other: Bounds) -> bool:
    return np.array_equal(one, other, equal_nan=True)
