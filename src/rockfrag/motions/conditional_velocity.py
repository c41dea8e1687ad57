"""Peak ground velocity that comes with a level of another measure: Abrahamson and Bhasin (2020).

N. Abrahamson, S. Bhasin: Conditional ground-motion model for peak ground velocity for active crustal regions. PEER
Report 2020/05, Berkeley. With f = a2 up to M 5, a3 from M 7.5 and straight between, and Y the measure in g,

    ln PGV [cm/s] = a1 + f ln Y + a4 (M - 6) + a5 (8.5 - M)² + a6 ln(R + 5 exp(0.4 (M - 6)))
                    + (a7 + a8 (M - 5)) ln(Vs30 / 425)                                                    (3.4)

with coefficients for PGA and for the spectral acceleration at 1 s; the standard deviation grows between M 5 and 7
(3.9).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rockfrag.base.arrays import Floats


@dataclass(frozen=True)
class ConditionalModel:
    """Coefficients for one measure (Table 3.2).

    Attributes
    ----------
    a : a1 to a8
    tau, phi : standard deviations of ln PGV between earthquakes and within one, up to M 5 and from M 7 on
    """

    a: tuple[float, ...]
    tau: tuple[float, float]
    phi: tuple[float, float]

    def log_velocity(
        self, levels: Floats, magnitude: float, distance_km: float, vs30: float
    ) -> Floats:
        """Median of ln PGV at levels of the measure.

        Parameters
        ----------
        levels : of the measure [g]
        magnitude : moment magnitude
        distance_km : to the rupture [km]
        vs30 : mean velocity of shear waves in the upper 30 m [m/s]

        Returns
        -------
        ln PGV [ln cm/s], of the shape of the levels.
        """
        a1, _, _, a4, a5, a6, a7, a8 = self.a
        near = math.log(distance_km + 5 * math.exp(0.4 * (magnitude - 6)))
        ground = (a7 + a8 * (magnitude - 5)) * math.log(vs30 / 425)
        of_source = a4 * (magnitude - 6) + a5 * (8.5 - magnitude) ** 2
        slope = self.slope(magnitude)
        return np.asarray(a1 + slope * np.log(levels) + of_source + a6 * near + ground)

    def slope(self, magnitude: float) -> float:
        """How ln PGV grows with the logarithm of the measure [-]."""
        return float(np.interp(magnitude, [5.0, 7.5], self.a[1:3]))

    def spreads(self, magnitude: float) -> tuple[float, float]:
        """Standard deviations of ln PGV between earthquakes and within one [-]."""
        magnitudes = [5.0, 7.0]
        tau = float(np.interp(magnitude, magnitudes, self.tau))
        return tau, float(np.interp(magnitude, magnitudes, self.phi))


BY_PGA = ConditionalModel(
    a=(4.77, 0.738, 0.484, 0.275, -0.036, -0.332, -0.44, 0.0),
    tau=(0.12, 0.26),
    phi=(0.32, 0.42),
)
BY_SA_1S = ConditionalModel(
    a=(4.80, 0.82, 0.55, 0.27, 0.054, -0.382, -0.21, 0.0),
    tau=(0.12, 0.17),
    phi=(0.28, 0.38),
)

MODELS: Mapping[str, ConditionalModel] = {"PGA": BY_PGA, "SA(1)": BY_SA_1S}
"""Models by measure."""
