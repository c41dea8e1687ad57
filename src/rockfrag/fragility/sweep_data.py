"""What curves need of the sweeps of one configuration, whether these are rows of a table or counts."""

from dataclasses import dataclass
from typing import Protocol

import pandas as pd

from rockfrag.fragility.empirical import survival_windows
from rockfrag.fragility.observations import Outcomes, outcomes_from_table


class SweepData(Protocol):
    """Sweeps of one configuration."""

    def windows(self, amplitude: str, by: list[str]) -> pd.DataFrame:
        """Survival windows, a row a motion, see :func:`rockfrag.fragility.empirical.survival_windows`."""

    def outcomes(self, column: str) -> Outcomes:
        """All verdicts with a measure."""

    def motions(self) -> pd.DataFrame:
        """One row per motion."""


@dataclass(frozen=True)
class TableSweep:
    """Sweeps as a table with a row per motion and amplitude.

    Attributes
    ----------
    table
        With ``motion``, ``overturned``, the amplitude and the measures.
    event
        Column of the earthquake; None where motions have none.
    motion
        Column of the motion.
    """

    table: pd.DataFrame
    event: str | None = "event"
    motion: str = "motion"

    def windows(self, amplitude: str, by: list[str]) -> pd.DataFrame:
        """See :class:`SweepData`."""
        return survival_windows(self.table, amplitude=amplitude, by=by)

    def outcomes(self, column: str) -> Outcomes:
        """See :class:`SweepData`."""
        return outcomes_from_table(
            self.table, column, motion=self.motion, event=self.event, source="sweep"
        )

    def motions(self) -> pd.DataFrame:
        """See :class:`SweepData`."""
        return self.table.drop_duplicates(self.motion)
