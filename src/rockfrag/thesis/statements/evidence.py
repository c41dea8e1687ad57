"""What the statements are tested on, brought into the forms that the tests need."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from rockfrag.pedestal.cluster_means import Estimate, mean_effect
from rockfrag.pedestal.mixed import long_rows
from rockfrag.pedestal.paired_tests import Pairs, check_tests, pair_tests
from rockfrag.pedestal.study import effects_table
from rockfrag.rocking.bodies import Block
from rockfrag.thesis.specimens import SLENDERNESS


class Undecidable(Exception):
    """The data at hand cannot speak about a statement; the message says why."""


@dataclass(frozen=True)
class Evidence:
    """One table of tests and what may accompany it.

    Parameters
    ----------
    tests
        See `rockfrag.pedestal.paired_tests.check_tests`; columns friction_demand [-] and
        least_normal_force_n [N] are used for C57, force_n [N] and moved_mass_kg [kg] for C56.
    basis
        ``simulated`` or ``measured``.
    seed
        Of the bootstrap behind rank probabilities.
    measures
        Intensity measures by motion: name, pgv_over_pga_s, mean_period_s, d5_95_s.
    bodies
        Specimens by name, the pedestal as "P".
    sliding
        Pairs of simulations: event, rocking_g, sliding_g (overturning amplitude with and without
        the possibility to slide) [g].
    """

    tests: pd.DataFrame
    basis: str
    seed: int
    measures: pd.DataFrame | None = None
    bodies: Mapping[str, Block] | None = None
    sliding: pd.DataFrame | None = None

    @cached_property
    def clean(self) -> pd.DataFrame:
        """Checked tests."""
        return check_tests(self.tests)

    @cached_property
    def slenderness(self) -> dict[str, float]:
        """Height over width by tower [-]."""
        if self.bodies is None:
            return dict(SLENDERNESS)
        return {name: body.slenderness for name, body in self.bodies.items() if name != "P"}

    @cached_property
    def pairs(self) -> Pairs:
        """Tests in pairs."""
        return pair_tests(self.tests, self.slenderness)

    @property
    def table(self) -> pd.DataFrame:
        """Complete pairs.

        Raises
        ------
        Undecidable
            If there is none.
        """
        if self.pairs.table.empty:
            raise Undecidable("every pair has a test that never overturned")
        return self.pairs.table

    @cached_property
    def amplitudes(self) -> pd.DataFrame:
        """Two rows per complete pair: side ("P" or "NP"), ln_a, a_g and the pair's columns."""
        rows = long_rows(self.table)
        slenderness = rows["object"].map(self.slenderness)
        return rows.assign(
            side=np.where(rows["ped"] == 1, "P", "NP"),
            a_g=np.exp(rows["ln_a"]),
            slenderness=slenderness,
        )

    @cached_property
    def effects(self) -> pd.DataFrame:
        """P/NP for every scope, indexed by scope and level."""
        return effects_table(self.table).set_index(["scope", "level"])

    def part(self, **levels: str) -> pd.DataFrame:
        """Complete pairs at the given levels, such as ``floor="GF", tower="T1"``.

        Raises
        ------
        Undecidable
            If there is none.
        """
        rows = self.table
        for column, level in levels.items():
            rows = rows[rows[column] == self.level(column, level)]
        if rows.empty:
            raise Undecidable(f"no complete pair for {', '.join(levels.values())}")
        return rows

    def level(self, column: str, wanted: str) -> str:
        """The level as the table spells it ("Loma Prieta" may be "loma_prieta" there).

        Raises
        ------
        Undecidable
            If the table has no such level.
        """
        for name in self.table[column].unique():
            if _plain(str(name)) == _plain(wanted):
                return str(name)
        raise Undecidable(f"no complete pair with {column} {wanted}")

    def effect(self, **levels: str) -> Estimate:
        """Mean log ratio at the given levels."""
        return mean_effect(self.part(**levels))

    def p_holm(self, scope: str, level: str) -> float:
        """P value of a level's effect, adjusted within its family."""
        return float(self.effects["p_holm"].to_dict()[(scope, level)])


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter.isalnum())
