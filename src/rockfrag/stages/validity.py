"""What the model silently assumed in every test: no sliding and no jumping."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from rockfrag.records.motion import Motion
from rockfrag.study.configurations import Configuration


def validity_table(
    tests: pd.DataFrame, configurations: Sequence[Configuration], motions: Mapping[str, Motion]
) -> pd.DataFrame:
    """Simulate each test once more, at its reported amplitude, and look at the contact forces.

    Parameters
    ----------
    tests
        Tests of one reading, one repetition.
    configurations
        What was tested.
    motions
        Motions by name.

    Returns
    -------
    One row per test with an amplitude: ``test``, ``object``, ``pedestal``, ``event``, ``floor``,
    ``motion``, ``amplitude_g``, ``friction_demand`` (largest |T|/N at any interface [-]),
    ``least_normal_force_n`` (least N at any interface [N]; ≤ 0 where a block would have jumped) and
    ``closest_approach`` (how near the response came to an unstable equilibrium).
    """
    from rockfrag.motions.scaling import scale_to_pga
    from rockfrag.rocking import simulate

    by_name = {one.name: one for one in configurations}
    known = tests[tests["amplitude_g"].notna()]
    rows = []
    for test in known.to_dict("records"):
        motion = motions[test["motion"]]
        shaken = scale_to_pga(motion, test["amplitude_g"])
        one = by_name[test["configuration"]]
        response = simulate(one.body, shaken.acceleration, shaken.dt, restitution=one.restitution)
        rows.append(
            (
                float(np.max(response.friction_demand)),
                float(np.min(response.least_normal_force)),
                response.closest_approach,
            )
        )
    keys = ["test", "object", "pedestal", "event", "floor", "motion", "amplitude_g"]
    found = pd.DataFrame(
        rows, columns=["friction_demand", "least_normal_force_n", "closest_approach"]
    )
    return pd.concat([known[keys].reset_index(drop=True), found], axis=1)
