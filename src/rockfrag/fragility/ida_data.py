"""What curves need of the IDA curves of one configuration, whether these are rows of a table or counts."""

from dataclasses import dataclass
from typing import Protocol

import pandas as pd

from rockfrag.fragility.empirical import find_resurrections
from rockfrag.fragility.observations import Observations, observations_from_table


class IdaData(Protocol):
    """IDA curves of one configuration."""

    def resurrections(self, amplitude: str, by: list[str]) -> pd.DataFrame:
        """Structural resurrections, a row a motion: :func:`rockfrag.fragility.empirical.find_resurrections`."""

    def outcomes(self, column: str) -> Observations:
        """All outcomes with a measure."""

    def motions(self) -> pd.DataFrame:
        """One row per motion."""


@dataclass(frozen=True)
class TableIda:
    """IDA curves as a table with a row per motion and amplitude."""

    table: pd.DataFrame  # with ``motion``, ``overturned``, the amplitude and the measures
    earthquake: str | None = "earthquake"  # column of the earthquake; None where motions have none
    motion: str = "motion"  # column of the motion

    def resurrections(self, amplitude: str, by: list[str]) -> pd.DataFrame:
        """See :class:`IdaData`."""
        return find_resurrections(self.table, amplitude=amplitude, by=by)

    def outcomes(self, column: str) -> Observations:
        """See :class:`IdaData`."""
        return observations_from_table(
            self.table, column, motion=self.motion, earthquake=self.earthquake, source="ida"
        )

    def motions(self) -> pd.DataFrame:
        """See :class:`IdaData`."""
        return self.table.drop_duplicates(self.motion)
