"""Tables 3.1, 3.3 and 4.1 of the thesis, computed again beside the printed values."""

import math
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from rockfrag.motions.intensity import pga, pgd, pgv
from rockfrag.records.motion import Motion
from rockfrag.system.blocks import Block, SystemLike, as_system
from rockfrag.system.system import System, uplift_ratios
from rockfrag.tabular import read_rows
from rockfrag.units import CENTIMETRES_PER_METRE, GRAVITY

FOLDER = Path(__file__).parent / "printed"
"""The tables as printed: ``table_3_1.csv``, ``table_3_3.csv`` and ``table_4_1.csv``."""

COLUMNS = ("name", "quantity", "unit", "computed", "printed", "agrees")
"""Columns of a comparison; ``agrees``: whether the computed value rounds to the printed digits."""


@dataclass(frozen=True)
class Quantity:
    """A column of a printed table: its name in the file, how readers call it, its unit."""

    column: str
    symbol: str
    unit: str


TABLE_3_1 = (
    Quantity("critical_angle_rad", "θc", "rad"),
    Quantity("radius_cm", "R", "cm"),
    Quantity("frequency_1_s", "p", "1/s"),
    Quantity("slenderness", "H/B", "-"),
)
TABLE_3_3 = (
    Quantity("pga_g", "PGA", "g"),
    Quantity("pgv_cm_s", "PGV", "cm/s"),
    Quantity("pgd_cm", "PGD", "cm"),
)
TABLE_4_1 = (
    Quantity("pattern_3_m_s2", "pattern 3", "m/s²"),
    Quantity("pattern_4_m_s2", "pattern 4", "m/s²"),
)


def block_properties(blocks: Mapping[str, Block]) -> pd.DataFrame:
    """Properties of Table 3.1 of each block: ``name`` and the columns of ``TABLE_3_1``."""
    return pd.DataFrame(
        {
            "name": list(blocks),
            "critical_angle_rad": [block.alpha for block in blocks.values()],
            "radius_cm": [block.radius() * CENTIMETRES_PER_METRE for block in blocks.values()],
            "frequency_1_s": [block.frequency() for block in blocks.values()],
            "slenderness": [block.slenderness for block in blocks.values()],
        }
    )


def uplift_accelerations(body: SystemLike) -> tuple[float, float]:
    """Least accelerations [m/s²] at which a body starts to rock in pattern 3 and in pattern 4.

    A lone block rocks like a statue on a pedestal that cannot move: its own value is that of pattern 4, and its
    pattern 3 is NaN.
    """
    *together, alone = (GRAVITY * ratio for ratio in uplift_ratios(as_system(body)))
    return min(together, default=math.nan), alone


def uplift_table(configurations: Sequence[System]) -> pd.DataFrame:
    """Accelerations of Table 4.1: ``name`` and the columns of ``TABLE_4_1``."""
    rows = [
        (configuration.name, *uplift_accelerations(configuration))
        for configuration in configurations
    ]
    return pd.DataFrame(rows, columns=["name", *(q.column for q in TABLE_4_1)])


def compare(
    computed: pd.DataFrame, quantities: Sequence[Quantity], printed: str | os.PathLike[str] | None
) -> pd.DataFrame:
    """Put computed values, a row per ``name`` and a column per quantity, beside printed ones.

    ``printed`` is a CSV file whose first column has the names and whose numbers have the printed decimals, or
    None.

    Returns ``COLUMNS``. Where nothing is printed, ``printed`` is empty and ``agrees`` is missing; ``printed`` is
    text, so that its decimals are kept.
    """
    wanted = {} if printed is None else _printed(printed, quantities)
    rows = []
    for row in computed.to_dict("records"):
        for quantity in quantities:
            value, text = row[quantity.column], wanted.get((row["name"], quantity.column), "")
            agrees = _rounds_to(value, text) if text else None
            rows.append((row["name"], quantity.symbol, quantity.unit, value, text, agrees))
    table = pd.DataFrame(rows, columns=list(COLUMNS))
    table["agrees"] = table["agrees"].astype("boolean")
    # a quantity that exists neither on paper nor in theory, such as pattern 3 of a lone block
    return table[table["computed"].notna() | (table["printed"] != "")].reset_index(drop=True)


def _printed(
    path: str | os.PathLike[str], quantities: Sequence[Quantity]
) -> dict[tuple[str, str], str]:
    columns = [quantity.column for quantity in quantities]
    rows = read_rows(path, ["name", *columns], ["magnitude_mw"])
    for row in rows:
        for column in columns:
            if row.cells[column]:
                row.number(column)
    return {(row.text("name"), column): row.cells[column] for row in rows for column in columns}


def _rounds_to(value: float, text: str) -> bool:
    decimals = len(text.partition(".")[2])
    return f"{value:.{decimals}f}" == text


def ground_measures(motions: Sequence[Motion]) -> pd.DataFrame:
    """Peaks of Table 3.3 of each ground motion: ``name`` and the columns of ``TABLE_3_3``."""
    return pd.DataFrame(
        {
            "name": [motion.name for motion in motions],
            "pga_g": [pga(motion) / GRAVITY for motion in motions],
            "pgv_cm_s": [pgv(motion) * CENTIMETRES_PER_METRE for motion in motions],
            "pgd_cm": [pgd(motion) * CENTIMETRES_PER_METRE for motion in motions],
        }
    )
