"""Tables 3.1, 3.3 and 4.1 of the thesis, computed again beside the printed values."""

import math
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from rockfrag.base.tabular import read_rows
from rockfrag.base.units import CENTIMETRES_PER_METRE, GRAVITY
from rockfrag.motions.intensity import pga, pgd, pgv
from rockfrag.system.blocks import SystemLike, as_system
from rockfrag.system.system import uplift_ratios

FOLDER = Path(__file__).parent / "printed"
"""The tables as printed: ``table_3_1.csv``, ``table_3_3.csv`` and ``table_4_1.csv``."""

COLUMNS = ("name", "quantity", "unit", "computed", "printed", "agrees")
"""Columns of a comparison; ``agrees``: whether the computed value rounds to the printed digits."""


class Quantity(NamedTuple):
    """A column of a printed table: its name in the file, how readers call it, its unit, and how it is computed."""

    column: str
    symbol: str
    unit: str
    of: Callable[[Any], float]


def uplift_accelerations(body: SystemLike) -> tuple[float, float]:
    """Least accelerations [m/s²] at which a body starts to rock in pattern 3 and in pattern 4.

    A lone block rocks like a statue on a pedestal that cannot move: its own value is that of pattern 4, and its
    pattern 3 is NaN.
    """
    *together, alone = (GRAVITY * ratio for ratio in uplift_ratios(as_system(body)))
    return min(together, default=math.nan), alone


TABLE_3_1 = (
    Quantity("critical_angle_rad", "θc", "rad", lambda block: block.alpha),
    Quantity(
        "radius_cm", "R", "cm", lambda block: block.radius() * CENTIMETRES_PER_METRE
    ),
    Quantity("frequency_1_s", "p", "1/s", lambda block: block.frequency()),
    Quantity("slenderness", "H/B", "-", lambda block: block.slenderness),
)
TABLE_3_3 = (
    Quantity("pga_g", "PGA", "g", lambda motion: pga(motion) / GRAVITY),
    Quantity(
        "pgv_cm_s", "PGV", "cm/s", lambda motion: pgv(motion) * CENTIMETRES_PER_METRE
    ),
    Quantity("pgd_cm", "PGD", "cm", lambda motion: pgd(motion) * CENTIMETRES_PER_METRE),
)
TABLE_4_1 = (
    Quantity(
        "pattern_3_m_s2",
        "pattern 3",
        "m/s²",
        lambda body: uplift_accelerations(body)[0],
    ),
    Quantity(
        "pattern_4_m_s2",
        "pattern 4",
        "m/s²",
        lambda body: uplift_accelerations(body)[1],
    ),
)
"""Quantities of blocks, of ground motions, and of what stands on the table."""


def compare(
    things: Mapping[str, Any],
    quantities: Sequence[Quantity],
    printed: str | os.PathLike[str],
) -> pd.DataFrame:
    """Compute quantities of things by their names, and put them beside printed ones.

    ``printed`` is a CSV file whose first column has the names and whose numbers have the printed decimals.

    Returns ``COLUMNS``. Where nothing is printed, ``printed`` is empty and ``agrees`` is missing; ``printed`` is
    text, so that its decimals are kept.
    """
    wanted = _printed(printed, quantities)
    rows = []
    for name, thing in things.items():
        for quantity in quantities:
            value, text = quantity.of(thing), wanted.get((name, quantity.column), "")
            decimals = len(text.partition(".")[2])
            agrees = f"{value:.{decimals}f}" == text if text else None
            rows.append((name, quantity.symbol, quantity.unit, value, text, agrees))
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    table["agrees"] = table["agrees"].astype("boolean")
    # a quantity that exists neither on paper nor in theory, such as pattern 3 of a lone block
    return table[table["computed"].notna() | (table["printed"] != "")].reset_index(
        drop=True
    )


def _printed(
    path: str | os.PathLike[str], quantities: Sequence[Quantity]
) -> dict[tuple[str, str], str]:
    """Cells of a printed table by name and column."""
    columns = [quantity.column for quantity in quantities]
    rows = read_rows(path, ["name", *columns], ["magnitude_mw"])
    for row in rows:
        for column in columns:
            if row.cells[column]:
                row.number(column)
    return {
        (row.text("name"), column): row.cells[column]
        for row in rows
        for column in columns
    }
