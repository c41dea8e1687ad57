"""A gallery: many objects, one line each, the one most at risk first."""

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from rockfrag.assess.answer import RECORDS, Assessment, assess_with
from rockfrag.assess.motions import MotionSet, motion_set
from rockfrag.assess.page import write_answer
from rockfrag.assess.request import Request, make_request
from rockfrag.assess.words import estimate_words
from rockfrag.errors import InputError
from rockfrag.files import distinct_file_names, write_table
from rockfrag.tabular import Row, read_rows

SIZES = ("width_m", "height_m", "depth_m", "mass_kg", "cg_height_m")
PEDESTAL = ("pedestal_width_m", "pedestal_height_m", "pedestal_depth_m", "pedestal_mass_kg")
OTHERS = ("floor", "restitution")
MOST_OBJECTS = 10_000
"""Rows of an inventory."""


@dataclass(frozen=True, eq=False)
class Inventory:
    """Objects of an inventory, assessed.

    Attributes
    ----------
    found
        Assessments, the one most at risk first.
    motions
        The motions on the ground that they share.
    """

    found: Sequence[Assessment]
    motions: MotionSet


def assess_inventory(
    path: str | os.PathLike[str],
    shared: Mapping[str, Any] | None = None,
    records: str | Path = RECORDS,
) -> Inventory:
    """Assess every object of a table.

    Parameters
    ----------
    path
        CSV with ``name``, ``width``, ``height`` and, where known, ``depth``, ``mass``, ``cg_height``,
        ``pedestal_width``, ``pedestal_height``, ``pedestal_depth``, ``pedestal_mass``, ``floor`` and
        ``restitution``; units stand in the titles or in the cells.
    shared
        What holds for all, with the keys of ``statue.yaml``, such as the hazard.
    records
        Folder of fetched records.

    Raises
    ------
    InputError
        If the table or an object cannot be used; the message names the line.
    """
    requests = read_inventory(path, shared or {})
    motions: MotionSet | None = None
    found = []
    for request in requests:
        if motions is None:
            motions = motion_set(request.records, request.place, Path(records))
        found.append(assess_with(request, motions.at(request.place), brief=True))
    assert motions is not None  # a table has a row
    found.sort(key=_risk, reverse=True)
    return Inventory(found, motions)


def read_inventory(path: str | os.PathLike[str], shared: Mapping[str, Any]) -> list[Request]:
    """Read the objects of a table.

    Parameters
    ----------
    path
        The table, see :func:`assess_inventory`.
    shared
        What holds for all.

    Raises
    ------
    InputError
        If the table or an object cannot be used.
    """
    needed = ["name", *SIZES[:2]]
    rows = read_rows(path, needed, [*SIZES[2:], *PEDESTAL, *OTHERS], quantities=(*SIZES, *PEDESTAL))
    if len(rows) > MOST_OBJECTS:
        raise InputError(f"{path}: {len(rows)} objects are more than the {MOST_OBJECTS} allowed.")
    distinct_file_names([row.text("name") for row in rows])
    names = [row.text("name") for row in rows]
    twice = next((name for name in names if names.count(name) > 1), None)
    if twice is not None:
        raise InputError(f"{path}: object {twice!r} is there twice; give each its own name.")
    return [_request(row, shared) for row in rows]


def _request(row: Row, shared: Mapping[str, Any]) -> Request:
    own: dict[str, Any] = {"name": row.text("name")}
    own |= {key: row.positive_quantity(key) for key in SIZES if row.has(key)}
    pedestal = {
        key.removeprefix("pedestal_"): row.positive_quantity(key)
        for key in PEDESTAL
        if row.has(key)
    }
    if pedestal:
        own["pedestal"] = pedestal
    if row.has("floor"):
        own["floor"] = row.text("floor")
    if row.has("restitution"):
        own["restitution"] = row.positive("restitution")
    return make_request({**shared, **own}, f"{row.path}, line {row.line}")


def _risk(found: Assessment) -> tuple[float, float, float]:
    """What objects are sorted by: the probability, the share, and how little topples half of the motions."""
    main = [0.0 if one is None else one.value for one in (found.probability, found.share)]
    return main[0], main[1], -found.amplitudes[0.5].value


def inventory_table(inventory: Inventory) -> pd.DataFrame:
    """A row an object: what it is called, where it stands and how it fares."""
    rows = []
    for found in inventory.found:
        row: dict[str, Any] = {"name": found.request.name, "place": found.request.place.words}
        for name, one in (("probability", found.probability), ("share", found.share)):
            if one is not None:
                row |= {name: one.value, f"{name}_lower": one.lower, f"{name}_upper": one.upper}
        row |= {
            f"{found.measure.column}_tenth": found.amplitudes[0.1].value,
            f"{found.measure.column}_half": found.amplitudes[0.5].value,
        }
        rows.append(row)
    return pd.DataFrame(rows)


def inventory_lines(inventory: Inventory) -> list[str]:
    """One line an object, the one most at risk first."""
    first = inventory.found[0]
    longest = max(len(found.request.name) for found in inventory.found)
    head = f"{len(inventory.found)} objects, the one most at risk first"
    if first.probability:
        head += f": probability of toppling in {first.request.years:g} years"
    elif first.level:
        head += f": share of the motions that topple it at {first.level.words}"
    lines = [f"{head} (90 % interval)."]
    for i, found in enumerate(inventory.found, start=1):
        main = found.probability or found.share
        half = found.amplitudes[0.5].value
        words = estimate_words(main) if main else ""
        lines.append(
            f"{i:4d}  {found.request.name:<{longest}}  {words:<24} half of the motions topple it at "
            f"{half:.2g} {found.measure.unit}, {found.request.place.words}"
        )
    return lines


def write_inventory(
    inventory: Inventory, folder: str | os.PathLike[str], *, pages: bool = False
) -> Path:
    """Write the ranking as CSV and, if wanted, the whole answer of each object; return the path of the table.

    Parameters
    ----------
    inventory
        The objects.
    folder
        Where to write; made if absent.
    pages
        Whether to assess each object in full and write its page.
    """
    place = Path(folder) / "inventory.csv"
    write_table(inventory_table(inventory), place)
    if pages:
        for found in inventory.found:
            motions = inventory.motions.at(found.request.place)
            write_answer(assess_with(found.request, motions), folder)
    return place
