"""What the hypotheses about the experiment are tested on, brought into the forms that the tests need.

In: results of a study. Out: tests by tower, floor and earthquake, amplitudes [g]. Docs: ``docs/hypotheses.md``.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from rockfrag.base.errors import InputError
from rockfrag.effects.cluster_means import Estimate, mean_effect
from rockfrag.effects.paired_tests import (
    Pairs,
    check_tests,
    pair_tests,
    pedestals_apart,
)
from rockfrag.system.blocks import Block
from rockfrag_thesis.hypotheses.contrasts import contrast
from rockfrag_thesis.hypotheses.hypothesis import Undecidable

PEDESTAL = "P"  # name of the pedestal among the specimens

THESIS_BODIES: Mapping[str, Block] = {
    "T1": Block(0.124, 0.372, 2.172),
    "T2": Block(0.124, 0.496, 2.790),
    "T3": Block(0.124, 0.620, 3.456),
    "P": Block(0.184, 0.208, 2.300),
}
"""Towers and pedestal of Table 3.1, as in ``config/specimens.csv``, for tables of tests without their own."""


@dataclass(frozen=True)
class Evidence:
    """One table of tests and what may accompany it."""

    # See `rockfrag.effects.paired_tests.check_tests`; columns friction_demand [-] and
    # least_normal_force_n [N] are used for C57, force_n [N] and moved_mass_kg [kg] for C56
    tests: pd.DataFrame
    basis: str  # ``simulated`` or ``measured``
    # Intensity measures by motion: name, pgv_over_pga_s, mean_period_s, d5_95_s
    measures: pd.DataFrame | None = None
    # Specimens by name, the pedestal as "P"; without them those of the thesis
    bodies: Mapping[str, Block] | None = None

    @property
    def specimens(self) -> Mapping[str, Block]:
        """Specimens by name, the pedestal as "P"."""
        return THESIS_BODIES if self.bodies is None else self.bodies

    @property
    def slenderness(self) -> dict[str, float]:
        """Height over width by object [-]."""
        return {
            name: body.slenderness
            for name, body in self.specimens.items()
            if name != PEDESTAL
        }

    @cached_property
    def clean(self) -> pd.DataFrame:
        """Checked tests."""
        return check_tests(pedestals_apart(self.tests)[0])

    @cached_property
    def pairs(self) -> Pairs:
        """Tests in pairs; raises Undecidable if there is no pair, or the slenderness of an object is not known."""
        try:
            return pair_tests(self.tests, self.slenderness)
        except InputError as reason:
            raise Undecidable(str(reason)) from None

    @property
    def table(self) -> pd.DataFrame:
        """Pairs with a figure; raises Undecidable if there is none."""
        if self.pairs.table.empty:
            raise Undecidable("every pair has a test that never overturned")
        return self.pairs.table

    @cached_property
    def amplitudes(self) -> pd.DataFrame:
        """Two rows per pair: side ("P" or "NP"), ln_a, a_g, slenderness and the pair's columns."""
        kept = self.table[["object", "earthquake", "floor", "motion", "s_c"]]
        # the resolution of a test is half the width of its step [-], half that of its pair
        sides = [
            kept.assign(
                ped=ped,
                ln_a=np.log(self.table[column]),
                resolution=self.table["resolution"] / 2,
                side=side,
            )
            for ped, side, column in ((0, "NP", "a_np_g"), (1, "P", "a_p_g"))
        ]
        rows = pd.concat(sides, ignore_index=True)
        slenderness = rows["object"].map(self.slenderness)
        return rows.assign(a_g=np.exp(rows["ln_a"]), slenderness=slenderness)

    def part(self, **levels: str) -> pd.DataFrame:
        """Pairs at the given levels, such as ``floor="GF", object="T1"``; raises Undecidable if there is none."""
        rows = self.table
        for column, level in levels.items():
            rows = rows[rows[column] == self.level(column, level)]
        if rows.empty:
            raise Undecidable(f"no complete pair for {', '.join(levels.values())}")
        return rows

    def level(self, column: str, wanted: str) -> str:
        """The level as the table spells it ("loma_prieta"); raises Undecidable if the table has no such level."""
        try:
            return self._spelled[column, _plain(wanted)]
        except KeyError:
            raise Undecidable(f"no complete pair with {column} {wanted}") from None

    @cached_property
    def _spelled(self) -> dict[tuple[str, str], str]:
        """Levels as the table spells them, by column and plain spelling."""
        return {
            (column, _plain(name)): name
            for column in ("object", "earthquake", "floor")
            for name in reversed(self.table[column].astype(str).unique().tolist())
        }

    def effect(self, **levels: str) -> Estimate:
        """Mean log ratio P/NP at the given levels."""
        return mean_effect(self.part(**levels))

    def lead(
        self, factor: str, word: str, other: str, block: str = "earthquake"
    ) -> Estimate:
        """By how much the effect at one level of a factor exceeds that at another, block by block."""
        level, reference = self.level(factor, word), self.level(factor, other)
        return contrast(self.table, factor, level, reference, block=block)


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter.isalnum())
