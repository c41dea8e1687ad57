"""Figures of rocking spectra and of overturning thresholds.

In: a :class:`rockfrag.simulation.RockingSpectrum`, or :class:`rockfrag.simulation.Thresholds`. Out: a figure each.
Theory: Makris and Konstantinidis (2003) for the spectra, ``docs/definitions.md`` for thresholds.
"""

from collections.abc import Hashable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.errors import InputError

if TYPE_CHECKING:
    from rockfrag.simulation.rocking_spectra import RockingSpectrum
    from rockfrag.simulation.thresholds import Thresholds

MOST_ANGLES = len(style.OKABE_ITO)
MOST_ROWS = 40  # more rows of thresholds are not legible


def spectrum_figure(spectrum: "RockingSpectrum", title: str) -> Figure:
    """Draw peak rotations and velocities over 2π/p, and crosses at the upper edge where blocks overturn.

    Parameters
    ----------
    spectrum : of blocks of some critical angles
    title : heading

    Returns
    -------
    The figure.
    """
    if len(spectrum.alpha) > MOST_ANGLES:
        raise InputError(
            f"plot: {len(spectrum.alpha)} angles are more lines than {MOST_ANGLES} colours; draw fewer."
        )
    with style.panels(style.COLUMN_WIDTH, 4.0, 2, sharex=True) as (figure, axes):
        drawn = (
            ("Peak rotation\nover critical angle", spectrum.rotation),
            ("Peak angular velocity\nover p [rad]", spectrum.velocity),
        )
        for panel, (label, values) in zip(axes, drawn, strict=True):
            finite = values[np.isfinite(values)]
            top = 1.15 * (float(finite.max(initial=0.0)) or 1.0)
            for k, angle in enumerate(spectrum.alpha):
                colour = style.OKABE_ITO[k]
                stands = np.where(np.isfinite(values[k]), values[k], np.nan)
                word = f"α = {angle:.3g} rad"
                panel.plot(
                    spectrum.period,
                    stands,
                    ".-",
                    ms=3,
                    lw=0.9,
                    color=colour,
                    label=word,
                )
                fallen = spectrum.period[np.isinf(values[k])]
                # rows of crosses, so that those of several angles do not hide each other
                at = np.full(fallen.size, top * (1 + 0.07 * k))
                panel.plot(fallen, at, "x", ms=4, mew=0.8, color=colour)
            panel.set_ylabel(label)
            panel.set_ylim(0, top * (1.05 + 0.07 * len(spectrum.alpha)))
        axes[0].set_title(
            style.checked_title(title) or "crosses: overturned", loc="left"
        )
        axes[-1].set_xlabel("2π/p [s]")
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2)
        return figure


def thresholds_figure(found: "Thresholds", title: str) -> Figure:
    """Draw a row a body and motion: a bar from the first overturning on, with gaps of survival.

    Parameters
    ----------
    found : thresholds and resurrections
    title : heading

    Returns
    -------
    The figure.
    """
    table = found.table
    if not 0 < len(table) <= MOST_ROWS:
        raise InputError(
            f"plot: {len(table)} rows of bodies and motions; draw 1 to {MOST_ROWS} at a time."
        )
    with style.panels(style.COLUMN_WIDTH, 0.9 + 0.22 * len(table)) as (figure, axes):
        for y, row in enumerate(table.to_dict("records")):
            if np.isfinite(row["first_overturning"]):
                _bars(axes, y, row, found)
        axes.set_ylim(len(table) - 0.4, -0.6)
        axes.set_yticks(range(len(table)), _rows(found))
        axes.tick_params(axis="y", length=0)
        axes.set_xlim(left=0)
        axes.set_xlabel("Peak of the motion [g]; bars: overturns")
        axes.set_title(style.checked_title(title), loc="left")
        return figure


def _bars(axes: Axes, y: int, row: Mapping[Hashable, Any], found: "Thresholds") -> None:
    """Draw the ranges of the peak [g] that overturn, between the resurrections of a row.

    Parameters
    ----------
    axes, y : to draw on, and at which height
    row : of the table of thresholds, of a body under a motion
    found : thresholds, with all resurrections
    """
    gaps = found.resurrections
    own = gaps[(gaps["body"] == row["body"]) & (gaps["motion"] == row["motion"])]
    starts = [row["first_overturning"], *own["upper"]]
    ends = [*own["lower"], found.highest]
    peak_g = row["first_overturning_pga_g"] / row["first_overturning"]
    for start, end in zip(starts, ends, strict=True):
        if end > start:
            left, width = peak_g * start, peak_g * (end - start)
            axes.barh(y, width, left=left, height=0.6, color=style.BLUE)


def _rows(found: "Thresholds") -> list[str]:
    """Names of the rows: of body and motion, as far as there are several."""
    table = found.table
    several = [table["body"].nunique() > 1, table["motion"].nunique() > 1]
    names = []
    for row in table.to_dict("records"):
        each = [
            row[f"{what}_name"] or f"{what} {row[what] + 1}"
            for what in ("body", "motion")
        ]
        shown = [name for name, many in zip(each, several, strict=True) if many]
        names.append(", ".join(shown) or each[0])
    return names
