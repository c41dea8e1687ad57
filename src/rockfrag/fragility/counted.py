"""Outcomes of large analyses as counts, so that fitting curves takes no more memory for more amplitudes.

Estimates and their limits need only how many outcomes lie in each narrow cell of the measure and how many of those
overturned, by what is resampled together; the goodness of fit needs the motions' own scales as well.

In: parts of IDA curves (:class:`rockfrag.shaketable.definitions.Swept`), one after the other. Out:
:class:`CountedIda`, which the estimators take as they take a table. Theory: ``docs/fragility.md``, "Estimators".
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike, NDArray

from rockfrag.fragility.empirical import TableIda
from rockfrag.fragility.ida_curves import scale_power
from rockfrag.fragility.intervals import blocks_of
from rockfrag.fragility.observations import (
    Floats,
    Observations,
    name_and_unit,
    positive,
)
from rockfrag.shaketable.definitions import Swept

CELLS = 2000  # cells of equal width in the logarithm of a measure


@dataclass(frozen=True, kw_only=True)
class CountedObservations(Observations):
    """Outcomes whose rows are the cells of each block of motions (earthquakes), see :class:`Observations`."""

    of: "_Counts" = field(repr=False)

    @property
    def n_motions(self) -> int:
        """Number of different motions."""
        return self.of.here.size

    @property
    def n_earthquakes(self) -> int:
        """Number of different earthquakes."""
        return self.of.earthquakes

    @property
    def is_swept(self) -> bool:
        """Every motion has several rows."""
        return True

    def log_arrangements(self) -> Floats:
        """Zero: which of a cell's tests overturned is known."""
        return np.zeros(1)

    def by_value(self) -> Observations:
        """Cells of all blocks together."""
        values, cell = np.unique(self.im, return_inverse=True)
        return self.pooled(cell, values)

    def group_weights(self, weights: Floats) -> Floats:
        """Weights of the blocks of motions, shape (batch, blocks), from those of groups, shape (batch, groups).

        All groups of a block must weigh the same.
        """
        block = self.of.block
        first = np.unique(block, return_index=True)[1]
        found = weights[:, first]
        if not np.array_equal(found[:, block], weights):
            raise ValueError(
                "counts are kept by block, whose motions cannot be weighted apart"
            )
        return found

    def independent(self, inside: NDArray[np.bool_]) -> tuple[int, float]:
        """How many motions have tests in the rows ``inside``, neighbouring cells, and how much they count.

        As in :meth:`Observations.independent`; here the tests of a motion count once, so both are the same.
        Motion i has tests at ``rise`` + ``scale[i]`` in ln of the measure: it counts where one of them lies from
        the lower edge of the first cell to the upper edge of the last.
        """
        edges, rise, scale = self.of.edges, self.of.rise, self.of.scale
        low = self._edge_below(self.im[inside].min())
        largest = np.log(self.im[inside].max())
        high = edges[np.searchsorted(edges, largest, side="right")]
        first = np.searchsorted(rise, low - scale)
        after = np.searchsorted(rise, high - scale)
        count = int((after > first).sum())
        return count, float(count)

    def drawn(self, capacity: Floats, cell: NDArray[np.intp]) -> Floats:
        """Outcomes by cell where each motion has one capacity [ln IM], see :class:`Observations`.

        ``cell`` rises with the measure, so that a cell is a range of ln IM. The tests of a motion in it that lie
        above its capacity fall: all below the end of the range, less those below its beginning or the capacity.
        """
        values, first = np.unique(self.im, return_index=True)
        starts = np.flatnonzero(np.diff(cell[first], prepend=-1))
        ends = np.append(self._edge_below(values[starts[1:]]), np.inf)
        rise, scale = self.of.rise, self.of.scale
        # of each motion, numbers of amplitudes below the ends of the ranges, shape (cells + 1, motions)
        before = [np.searchsorted(rise, end - scale) for end in ends]
        below = np.array([np.zeros(scale.size, dtype=np.intp), *before])
        # and numbers of those up to its capacity, which stand, shape (replicates, motions)
        stood = np.searchsorted(rise, capacity - scale, side="right")
        fallen = [
            np.diff(np.maximum(below, of_motion).sum(axis=1)) for of_motion in stood
        ]
        return np.array(fallen, dtype=np.float64)

    def _edge_below(self, im: ArrayLike) -> Floats:
        """Lower end of the cell that holds each value [ln IM]."""
        edges = self.of.edges
        return np.asarray(edges[np.searchsorted(edges, np.log(im), side="right") - 1])


@dataclass(frozen=True, kw_only=True)
class CountedIda(TableIda):
    """IDA curves on one floor, or on all, whose ``table`` has a row a motion with its resurrections."""

    counts: Mapping[str, "_Counts"]  # by measure

    def resurrections(self, amplitude: str) -> pd.DataFrame:
        """See :class:`TableIda`; ``amplitude`` is the one in g."""
        return self.table.sort_values(["motion", "earthquake"], ignore_index=True)

    def outcomes(self, column: str) -> Observations:
        """Outcomes with a measure."""
        return self.counts[column].outcomes()


def count_ida(
    windows: pd.DataFrame,
    parts: Iterable[Swept],
    measures: pd.DataFrame,
    columns: Mapping[str, Sequence[str]],
) -> dict[str, CountedIda]:
    """Count IDA curves of one configuration part by part, by floor.

    Parameters
    ----------
    windows, parts : resurrections of the motions of all parts, a row a motion, and the parts
    measures : a row per motion as recorded, with ``name`` and ``pga_g``
    columns : measures that will be asked for, by floor; the empty name stands for all floors together

    Returns
    -------
    The :class:`CountedIda` of each floor.
    """
    motions = pd.Index(windows["motion"])
    known = measures.set_index("name").loc[motions].reset_index()
    counts: dict[str, dict[str, _Counts]] = {}
    for part in parts:
        for floor, names in columns.items():
            of_floor = counts.setdefault(floor, {})
            for name in names:
                if name not in of_floor:
                    of_floor[name] = _Counts(
                        known, windows, floor, name, part.amplitude_g
                    )
        rows = motions.get_indexer(pd.Index(part.about["motion"]))
        for of_floor in counts.values():
            for count in of_floor.values():
                count.add(rows, part.overturned)
    return {
        floor: CountedIda(
            windows[windows["floor"] == floor] if floor else windows, counts=of_floor
        )
        for floor, of_floor in counts.items()
    }


class _Counts:
    """Tests and those that overturned, by block and cell of one measure.

    Attributes
    ----------
    column, here : the measure, and the motions of the floor by their rows, shape (used,)
    of_motion : place of each motion among those used, -1 for others, shape (motions,)
    scale : ln IM of each motion used at a peak of 1 g, shape (used,)
    rise : what each amplitude adds to it, shape (amplitudes,)
    block, row : of each group that is resampled, a motion or an earthquake, shape (groups,); of each motion used
    edges : ends of the cells in ln IM, shape (cells + 1,)
    trials, fell : numbers of tests, and of those that overturned, shape (blocks, cells)
    total : sum of ln IM of the tests of each cell, shape (cells,)
    """

    def __init__(
        self,
        known: pd.DataFrame,
        motions: pd.DataFrame,
        floor: str,
        column: str,
        amplitude_g: Floats,
    ) -> None:
        power = scale_power(column)
        here = np.arange(len(motions))
        if floor:
            here = np.flatnonzero(motions["floor"] == floor)
        value = positive(known.iloc[here], column, "measures")
        pga = positive(known.iloc[here], "pga_g", "measures")
        self.column, self.here = column, here
        self.scale = np.log(value) - power * np.log(pga)
        self.rise = power * np.log(amplitude_g)
        earthquake = pd.factorize(motions["earthquake"].iloc[here])[0]
        self.earthquakes = int(earthquake.max()) + 1
        # what is resampled: earthquakes where some have several motions
        group = earthquake if self.earthquakes < here.size else np.arange(here.size)
        self.block = blocks_of(int(group.max()) + 1)
        self.of_motion = np.full(len(motions), -1)
        self.of_motion[here] = np.arange(here.size)
        self.row = self.block[group]
        low = self.scale.min() + self.rise[0]
        high = self.scale.max() + self.rise[-1]
        # a little more on either side, so that rounding puts no test outside
        self.edges = np.linspace(low - 1e-9, high + 1e-9, CELLS + 1)
        shape = int(self.block.max()) + 1, CELLS
        self.trials, self.fell = np.zeros(shape), np.zeros(shape)
        self.total = np.zeros(CELLS)

    def add(self, rows: NDArray[np.intp], overturned: NDArray[np.bool_]) -> None:
        """Count outcomes of motions.

        Parameters
        ----------
        rows : numbers of the motions, shape (n,); those on other floors are left out
        overturned : shape (n, amplitudes)
        """
        used = self.of_motion[rows] >= 0
        own = self.of_motion[rows][used]
        log_im = self.scale[own, np.newaxis] + self.rise
        width = (self.edges[-1] - self.edges[0]) / CELLS
        cell = np.clip(((log_im - self.edges[0]) / width).astype(np.intp), 0, CELLS - 1)
        # place of each test in the table of blocks and cells
        flat = self.row[own, np.newaxis] * CELLS + cell
        self.trials += self._by_cell(flat.ravel())
        self.fell += self._by_cell(flat[overturned[used]])
        # ln IM are added to the sum so far one by one, so that parts of a table give the bits of the whole
        terms = np.append(self.total, log_im)
        self.total[:] = np.bincount(np.append(np.arange(CELLS), cell), terms)

    def _by_cell(self, flat: NDArray[np.intp]) -> Floats:
        """Numbers of tests by block and cell from their flat places."""
        counts = np.bincount(flat, minlength=self.trials.size)
        return np.asarray(counts.reshape(self.trials.shape), dtype=np.float64)

    def outcomes(self) -> CountedObservations:
        """Cells of each block as outcomes."""
        block, cell = np.nonzero(self.trials)
        with np.errstate(invalid="ignore", divide="ignore"):
            middle = np.exp(self.total / self.trials.sum(axis=0))
        names = [f"block {number + 1}" for number in range(len(self.trials))]
        labels = np.array(names, dtype=object)[block]
        name, unit = name_and_unit(self.column)
        return CountedObservations(
            im=middle[cell],
            overturned=self.fell[block, cell],
            trials=self.trials[block, cell],
            motion=labels,
            earthquake=labels,
            name=name,
            unit=unit,
            of=self,
        )
