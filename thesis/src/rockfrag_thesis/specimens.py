"""The thesis's specimens, for tables of tests that come without their own."""

from collections.abc import Mapping

from rockfrag.system.blocks import Block

THESIS_BODIES: Mapping[str, Block] = {
    "T1": Block(0.124, 0.372, 2.172),
    "T2": Block(0.124, 0.496, 2.790),
    "T3": Block(0.124, 0.620, 3.456),
    "P": Block(0.184, 0.208, 2.300),
}
"""Towers and pedestal of Table 3.1, as in ``config/specimens.csv``."""
