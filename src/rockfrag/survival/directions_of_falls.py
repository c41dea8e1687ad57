"""Where falls point: the mean of their azimuths, and whether they point anywhere.

In: azimuths of falls, clockwise from north [degrees]. Out: :class:`FallDirection`. Square stones fall over an
edge, so that azimuths of one row of tombstones say in which of four directions it was; round ones and lanterns
say more (``docs/constrain-shaking.md``).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special

FEWEST = 5  # Azimuths below which no direction is given
POINTS_SOMEWHERE = 0.05  # p value of Rayleigh's test up to which falls point somewhere


@dataclass(frozen=True)
class FallDirection:
    """Direction of falls.

    Attributes
    ----------
    azimuth : mean, clockwise from north [degrees]
    within : half of the interval that holds it with 90 % [degrees]; 180 where it is open
    p_value : probability of so much agreement among falls that point anywhere (Rayleigh's test)
    count : azimuths that were measured
    """

    azimuth: float
    within: float
    p_value: float
    count: int

    @property
    def points_somewhere(self) -> bool:
        """Whether the falls agree more than by chance."""
        return self.p_value <= POINTS_SOMEWHERE


def fall_direction(azimuths: Sequence[float]) -> FallDirection | None:
    """Mean direction of falls (Mardia and Jupp 2000, Directional Statistics, 4.4 and 6.3).

    Parameters
    ----------
    azimuths : of falls, clockwise from north [degrees]

    Returns
    -------
    The direction; None of fewer than five.
    """
    n = len(azimuths)
    if n < FEWEST:
        return None
    angles = np.radians(azimuths)
    east, north = float(np.sin(angles).mean()), float(np.cos(angles).mean())
    length = math.hypot(east, north)
    mean = math.atan2(east, north)
    z = n * length**2
    # Rayleigh's p value to the order 1/n²
    p = math.exp(-z) * (1 + (2 * z - z**2) / (4 * n))
    p -= math.exp(-z) * (24 * z - 132 * z**2 + 76 * z**3 - 9 * z**4) / (288 * n**2)
    within = 180.0
    second = float(np.cos(2 * (angles - mean)).mean())
    if length > 0:
        spread = (1 - second) / (2 * length**2)
        reach = float(special.ndtri(0.95)) * math.sqrt(spread / n)
        within = math.degrees(math.asin(reach)) if reach < 1 else 180.0
    return FallDirection(math.degrees(mean) % 360.0, within, min(max(p, 0.0), 1.0), n)
