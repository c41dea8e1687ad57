"""The bodies of a study as a table, with what decides how they rock."""

from collections.abc import Sequence

import pandas as pd

from rockfrag.rocking.inputs import least_uplift
from rockfrag.study.configurations import Configuration
from rockfrag.system.blocks import Block, Body, Column
from rockfrag.units import GRAVITY


def uplift_accelerations(body: Body, g: float = GRAVITY) -> tuple[float, float]:
    """Least accelerations [m/s²] at which a body starts to rock in pattern 3 and in pattern 4.

    A body at rest opens about the pole whose overturning moment first exceeds the weight's
    (Psycharis, 1990). A lone block rocks like a statue on a pedestal that cannot move: its own
    value is that of pattern 4, and its pattern 3 is NaN. Of three and more blocks the first is the least at
    which any contact opens.
    """
    if isinstance(body, Block):
        return float("nan"), min(_tangent(body.arm(pole)) for pole in (+1, -1)) * g
    if isinstance(body, Column):
        top = body.blocks[-1]
        alone = min(_tangent(top.arm(pole)) for pole in (+1, -1)) * g
        return least_uplift(body.system(), g), alone
    return (
        min(_tangent(body.common_arm(pole)) for pole in (+1, -1)) * g,
        min(_tangent(body.statue_arm(pole)) for pole in (+1, -1)) * g,
    )


def _tangent(arm: Sequence[float]) -> float:
    return abs(arm[0]) / arm[1]


def bodies_table(configurations: Sequence[Configuration]) -> pd.DataFrame:
    """Return what is tested, a row per configuration.

    Returns
    -------
    pandas.DataFrame
        ``configuration``, ``object``, ``stands_on`` (the pedestal, empty for the floor); of the object
        ``width_m``, ``height_m``, ``mass_kg``, ``slenderness`` (height over width [-]),
        ``critical_angle_rad``, ``radius_m``, ``frequency_1_s``; ``uplift_m_s2``: least
        acceleration of the floor at which anything starts to rock [m/s²].
    """
    rows = []
    for one in configurations:
        block = one.statue
        together, alone = uplift_accelerations(one.body)
        rows.append(
            {
                "configuration": one.name,
                "object": one.object,
                "stands_on": one.pedestal,
                "width_m": block.width,
                "height_m": block.height,
                "mass_kg": block.mass,
                "slenderness": block.slenderness,
                "critical_angle_rad": block.alpha,
                "radius_m": block.radius(),
                "frequency_1_s": block.frequency(),
                "uplift_m_s2": alone if isinstance(one.body, Block) else min(together, alone),
            }
        )
    return pd.DataFrame(rows)
