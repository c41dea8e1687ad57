"""The bodies of a study as a table, with what decides how they rock."""

from collections.abc import Sequence

import pandas as pd

from rockfrag.system import geometry
from rockfrag.system.system import System, uplift_ratios
from rockfrag.units import GRAVITY


def bodies_table(configurations: Sequence[System]) -> pd.DataFrame:
    """Return what is tested, a row per configuration.

    Columns: ``configuration``, ``object``, ``stands_on`` (the pedestal, empty for the floor); of the object
    ``width_m``, ``height_m``, ``mass_kg``, ``slenderness`` (height over width [-]), ``critical_angle_rad``,
    ``radius_m``, ``frequency_1_s``; ``uplift_m_s2``: least acceleration of the floor at which anything starts to
    rock [m/s²].
    """
    rows = []
    for configuration in configurations:
        body, shape = configuration.bodies[-1], configuration.shapes[-1]
        rows.append(
            {
                "configuration": configuration.name,
                "object": configuration.names[-1],
                "stands_on": "|".join(configuration.names[-2::-1]),
                "width_m": body.width,
                "height_m": body.height,
                "mass_kg": body.mass,
                "slenderness": body.height / body.width,
                "critical_angle_rad": min(geometry.critical_angle(shape, k) for k in (+1, -1)),
                "radius_m": geometry.radius(shape, 1),
                "frequency_1_s": geometry.frequency(shape, 1, GRAVITY),
                "uplift_m_s2": GRAVITY * min(uplift_ratios(configuration)),
            }
        )
    return pd.DataFrame(rows)
