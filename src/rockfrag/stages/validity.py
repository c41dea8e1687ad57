"""What surfaces were asked for in the tests, and what sliding and flight did where friction is limited."""

from collections.abc import Iterable, Mapping, Sequence
from itertools import repeat
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.records.motion import Motion
from rockfrag.system.system import System

MOST_TESTED = 500
"""Tests of a configuration whose forces are looked at: of more this many, evenly among them."""


def validity_table(
    tests: pd.DataFrame,
    configurations: Sequence[System],
    motions: Mapping[str, Motion],
    vertical: Mapping[str, Motion] | None = None,
    threads: int = 1,
) -> pd.DataFrame:
    """Simulate tests once more, each at its reported amplitude, and look at the contact forces.

    ``tests`` are of one definition, one repetition. One row per test with an amplitude, ``MOST_TESTED`` of a
    configuration at most: ``test``, ``object``, ``pedestal``, ``earthquake``, ``floor``, ``motion``,
    ``amplitude_g``, ``friction_demand`` (largest |T|/N at any interface [-]), ``least_normal_force_n`` (least N
    at any interface [N]; ≤ 0 where a block would have jumped) and ``unstable_distance`` (how near the response
    came to an unstable equilibrium). With friction also ``peak_slip_m``, the largest displacement along any
    interface, and ``flights``.
    """
    known = tests[tests["amplitude_g"].notna()]
    known = known[_looked_at(known["configuration"])].reset_index(drop=True)
    columns = ["friction_demand", "least_normal_force_n", "unstable_distance"]
    if any(configuration.loose for configuration in configurations):
        columns += ["peak_slip_m", "flights"]
    parts = [pd.DataFrame(columns=columns)]
    for configuration in configurations:
        rows = known[known["configuration"] == configuration.name]
        if len(rows):
            forces = _forces(configuration, *_shaken(rows, motions, vertical), threads)
            parts.append(forces.set_index(rows.index))
    found = pd.concat(parts[1:] or parts)[columns].sort_index()
    keys = ["test", "object", "pedestal", "earthquake", "floor", "motion", "amplitude_g"]
    return pd.concat([known[keys], found], axis=1)


def _looked_at(configuration: pd.Series) -> NDArray[np.bool_]:
    """Which tests are simulated once more: all of a configuration, or some evenly among its many."""
    chosen = np.zeros(len(configuration), dtype=bool)
    for rows in configuration.groupby(configuration, sort=False).indices.values():
        step = max(1.0, len(rows) / MOST_TESTED)
        chosen[rows[np.arange(0, len(rows), step).astype(np.intp)]] = True
    return chosen


def _shaken(
    tests: pd.DataFrame, motions: Mapping[str, Motion], vertical: Mapping[str, Motion] | None
) -> tuple[list[Motion], list[NDArray[np.float64]] | None]:
    """Motion of each test as scaled, and the vertical acceleration beside it [m/s²]."""
    from rockfrag.motions.processing import scale_to_pga

    names = list(tests["motion"])
    scaled = [
        scale_to_pga(motions[name], amplitude)
        for name, amplitude in zip(names, tests["amplitude_g"], strict=True)
    ]
    if vertical is None:
        return scaled, None
    return scaled, [
        shaken.pga / motions[name].pga * vertical[name].acceleration
        for name, shaken in zip(names, scaled, strict=True)
    ]


def _forces(
    system: System, motions: list[Motion], vertical: list[NDArray[np.float64]] | None, threads: int
) -> pd.DataFrame:
    """Forces of a configuration under motions as they are, a row each."""
    from rockfrag.rocking import overturns

    if system.loose or system.count > 2:
        found = _in_contact(system, motions, vertical)
    else:
        found = overturns(system, motions, vertical=vertical, forces=True, threads=threads)
    return pd.DataFrame(
        {
            "friction_demand": found.of_any("friction_demand")[0, :, 0],
            "least_normal_force_n": found.of_any("least_normal_force")[0, :, 0],
            "peak_slip_m": found.of_any("peak_slip")[0, :, 0],
            **found.wide(0, ("unstable_distance", "flights")),
        }
    )


def _in_contact(
    system: System, motions: list[Motion], vertical: list[NDArray[np.float64]] | None
) -> Outcomes:
    """Outcomes with forces of what may slide, which histories alone tell."""
    from rockfrag.rocking import simulate

    found = empty_outcomes([system.names], np.ones((len(motions), 1)))
    for place, (motion, up) in enumerate(zip(motions, vertical or repeat(None), strict=False)):
        response = simulate(system, motion, vertical=up)
        at = (0, place, 0)
        found.friction_demand[at] = response.friction_demand
        found.least_normal_force[at] = response.least_normal_force
        found.peak_slip[at] = np.abs(response.slip).max(axis=0)
        found.unstable_distance[at] = response.unstable_distance
        found.flights[at] = (response.contact_events["kind"] == "flight").sum()
    return found


def sliding_table(files: Iterable[Path]) -> pd.DataFrame:
    """Count what friction did in the IDA curves of a study; one file is in memory at a time.

    One row per configuration: ``configuration``, ``cases``, ``slid``, ``flew`` (cases), ``largest_slip_m``,
    ``saved`` and ``felled`` (cases that overturn only without, and only with, sliding and flight).
    """
    outcomes = ["overturned", "overturned_without_sliding", "peak_slip_m", "flights"]
    parts = []
    for path in files:
        cases = pd.read_parquet(path, columns=["configuration", *outcomes])
        fell, fell_rough, slip, flights = (cases[name] for name in outcomes)
        each = cases[["configuration"]].assign(
            cases=1,
            slid=slip > 0,
            flew=flights > 0,
            largest_slip_m=slip,
            saved=fell_rough & ~fell,
            felled=fell & ~fell_rough,
        )
        parts.append(_added_up(each))
    return _added_up(pd.concat(parts, ignore_index=True))


def _added_up(table: pd.DataFrame) -> pd.DataFrame:
    how = dict.fromkeys(table.columns[1:], "sum") | {"largest_slip_m": "max"}
    return table.groupby("configuration", sort=False, as_index=False).agg(how)
