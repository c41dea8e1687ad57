"""Figure of an incremental dynamic analysis: peak rotations over the peak of the motion, and who falls.

In: :class:`rockfrag.outcomes.Outcomes` of systems × motions × scales. Out: a figure, a column a system.
Theory: ``docs/definitions.md``; Vamvatsikos and Cornell (2002) for incremental dynamic analysis.
"""

from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.arrays import Floats
from rockfrag.base.errors import InputError
from rockfrag.base.units import GRAVITY

if TYPE_CHECKING:
    from rockfrag.outcomes.outcomes import Outcomes

MOST_SYSTEMS = 4  # more have no room beside each other
MOST_NAMED = 7  # so many motions have a colour of their own and a name


def outcomes_figure(outcomes: "Outcomes", title: str) -> Figure:
    """Draw peak rotations of each system, and the fraction of motions that overturn it, over the peak [g].

    Parameters
    ----------
    outcomes : of systems × motions × scales
    title : heading

    Returns
    -------
    The figure.
    """
    systems, motions, _ = outcomes.shape
    if not outcomes.overturned.size:
        raise InputError("plot: there are no outcomes to draw.")
    if systems > MOST_SYSTEMS:
        raise InputError(
            f"plot: {systems} systems have no room in a figure; draw at most {MOST_SYSTEMS} at a time."
        )
    peaks_g = np.array(outcomes.peaks or [np.nan] * motions)[:, np.newaxis] / GRAVITY
    known = bool(np.isfinite(peaks_g).all())
    levels = np.abs(outcomes.scales) * (peaks_g if known else 1.0)
    rotation = outcomes.of_top("peak_rotation")
    width = min(style.COLUMN_WIDTH * systems, style.PAGE_WIDTH)
    shape = {"sharex": True, "sharey": "row", "squeeze": False, "height_ratios": [3, 2]}
    with style.panels(width, 3.6, 2, systems, **shape) as (figure, grid):
        for i in range(systems):
            _rotations(grid[0, i], levels, rotation[i], outcomes.motions)
            _fractions(grid[1, i], levels, outcomes.overturned[i])
            name = outcomes.systems[i] if outcomes.systems else ""
            if systems > 1 or name:
                grid[0, i].set_title(name or f"system {i + 1}", loc="left")
            word = "Peak of the motion [g]" if known else "Factor on the motion"
            grid[1, i].set_xlabel(word)
        grid[0, 0].set_ylabel("Peak rotation\nover critical angle")
        grid[1, 0].set_ylabel("Fraction that\noverturns")
        handles, labels = grid[0, 0].get_legend_handles_labels()
        if labels:
            figure.legend(handles, labels, loc="outside lower center", ncols=3)
        if title := style.checked_title(title):
            figure.suptitle(title)
        style.letter_panels(grid.ravel())
        return figure


def _rotations(
    axes: Axes, levels: Floats, rotation: Floats, names: tuple[str, ...]
) -> None:
    """Draw a line a motion up to its fall, and a row of crosses above where it overturns.

    ``levels``, ``rotation``: scales, and peak rotations over the critical angle, infinite for a fall, shape
    (motions, scales).
    """
    few = len(rotation) <= MOST_NAMED
    for j, values in enumerate(rotation):
        order = np.argsort(levels[j], kind="stable")
        x, y = levels[j][order], values[order]
        colour = style.OKABE_ITO[j] if few else style.GUIDE
        name = (names[j] if names else "") or f"motion {j + 1}"
        stands = np.where(np.isfinite(y), y, np.nan)
        label = name if few and len(rotation) > 1 else None
        axes.plot(x, stands, ".-", ms=3, lw=0.8, color=colour, label=label)
        fallen = x[np.isinf(y)]
        # rows of crosses, so that those of few motions do not hide each other
        row = np.full(fallen.size, 1.1 + (0.05 * j if few else 0.0))
        axes.plot(fallen, row, "x", ms=3.5, mew=0.8, color=colour)
    axes.axhline(1, color=style.GUIDE, lw=0.6, ls="--")
    axes.annotate(
        "crosses: overturned",
        (0.02, 0.95),
        xycoords="axes fraction",
        fontsize=6.5,
        va="top",
    )
    axes.set_ylim(0, 1.3 + 0.05 * (len(rotation) if few else 1))


def _fractions(axes: Axes, levels: Floats, overturned: Floats) -> None:
    """Draw the fraction of motions that overturn the system, at common levels or over the scales."""
    # equal peaks of several motions differ by rounding
    levels = np.round(levels, 9)
    order = np.argsort(levels, axis=1)
    levels = np.take_along_axis(levels, order, axis=1)
    fallen = np.take_along_axis(np.asarray(overturned, dtype=float), order, axis=1)
    grid = np.unique(levels)
    # each motion keeps the outcome of its nearest level below, and counts between its ends
    found = [
        fallen[j, np.clip(np.searchsorted(row, grid, side="right") - 1, 0, None)]
        for j, row in enumerate(levels)
    ]
    inside = (grid >= levels[:, :1]) & (grid <= levels[:, -1:])
    counted = inside.sum(axis=0)
    with np.errstate(invalid="ignore"):
        fraction = (np.array(found) * inside).sum(axis=0) / counted
    whole, most = counted == len(levels), 2 * counted >= len(levels)
    axes.step(grid[whole], fraction[whole], where="post", color=style.BLACK, lw=1.0)
    if most.sum() > whole.sum():
        # motions of unlike strength have few levels in common
        axes.step(grid[most], fraction[most], ":", where="post", color=style.GUIDE)
        axes.annotate(
            "dotted: of most motions", (0.02, 0.9), xycoords="axes fraction", va="top"
        ).set_fontsize(6.5)
    axes.set_ylim(-0.03, 1.03)
