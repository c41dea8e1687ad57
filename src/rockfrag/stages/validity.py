"""What surfaces were asked for in every test, and what sliding and flight did where friction is limited."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from rockfrag.records.motion import Motion
from rockfrag.study.configurations import Configuration


def validity_table(
    tests: pd.DataFrame,
    configurations: Sequence[Configuration],
    motions: Mapping[str, Motion],
    vertical: Mapping[str, Motion] | None = None,
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
    vertical
        Vertical motions by the same names; None shakes horizontally alone.

    Returns
    -------
    One row per test with an amplitude: ``test``, ``object``, ``pedestal``, ``event``, ``floor``,
    ``motion``, ``amplitude_g``, ``friction_demand`` (largest |T|/N at any interface [-]),
    ``least_normal_force_n`` (least N at any interface [N]; ≤ 0 where a block would have jumped) and
    ``closest_approach`` (how near the response came to an unstable equilibrium).  With friction also
    ``peak_slip_m``, the largest displacement along any interface, and ``flights``.
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
        up = None
        if vertical is not None:
            factor = shaken.pga / motion.pga
            up = factor * vertical[test["motion"]].acceleration
        response = simulate(
            one.body,
            shaken.acceleration,
            shaken.dt,
            restitution=one.restitution,
            friction=one.friction,
            vertical=up,
        )
        row: dict[str, float] = {
            "friction_demand": float(np.max(response.friction_demand)),
            "least_normal_force_n": float(np.min(response.least_normal_force)),
            "closest_approach": response.closest_approach,
        }
        if one.friction is not None:
            row["peak_slip_m"] = float(np.abs(response.slip).max())
            row["flights"] = int((response.events["kind"] == "flight").sum())
        rows.append(row)
    keys = ["test", "object", "pedestal", "event", "floor", "motion", "amplitude_g"]
    columns = ["friction_demand", "least_normal_force_n", "closest_approach"]
    if any(one.friction is not None for one in configurations):
        columns += ["peak_slip_m", "flights"]
    found = pd.DataFrame(rows, columns=columns)
    return pd.concat([known[keys].reset_index(drop=True), found], axis=1)


def sliding_table(files: Iterable[Path]) -> pd.DataFrame:
    """Count what friction did in the sweeps of a study.

    Parameters
    ----------
    files
        Files of the sweeps of all configurations, with slip; one is in memory at a time.

    Returns
    -------
    One row per configuration: ``configuration``, ``cases``, ``slid``, ``flew`` (cases), ``largest_slip_m``,
    ``saved`` and ``felled`` (cases that overturn only without, and only with, sliding and flight).
    """
    parts = [_sliding(pd.read_parquet(path, columns=list(_SLIDING))) for path in files]
    how = dict.fromkeys(parts[0].columns[1:], "sum") | {"largest_slip_m": "max"}
    both = pd.concat(parts, ignore_index=True)
    return both.groupby("configuration", sort=False, as_index=False).agg(how)


_SLIDING = (
    "configuration",
    "overturned",
    "overturned_without_sliding",
    "peak_slip_ground_m",
    "peak_slip_interface_m",
    "flights",
)


def _sliding(sweeps: pd.DataFrame) -> pd.DataFrame:
    fell, fell_rough = sweeps["overturned"], sweeps["overturned_without_sliding"]
    peak = sweeps[["peak_slip_ground_m", "peak_slip_interface_m"]].max(axis=1)
    each = pd.DataFrame(
        {
            "configuration": sweeps["configuration"],
            "cases": 1,
            "slid": peak > 0,
            "flew": sweeps["flights"] > 0,
            "largest_slip_m": peak,
            "saved": fell_rough & ~fell,
            "felled": fell & ~fell_rough,
        }
    )
    how = dict.fromkeys(each.columns[1:], "sum") | {"largest_slip_m": "max"}
    return each.groupby("configuration", sort=False, as_index=False).agg(how)
