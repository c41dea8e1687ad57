"""The figure of ``docs/toppling-velocity.md``: medians over height, and their ratio over Kaneko's curve.

In: tables of medians [m/s]. Out: a figure.
"""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from rockfrag.base import figure_style as style
from rockfrag.base.arrays import Floats
from rockfrag.fragility.toppling_velocity import (
    HEIGHTS,
    SLENDERNESSES,
    Surface,
)
from rockfrag.simulation.closed_forms import kaneko_velocity

DRAWN_WIDTHS = (0.1, 0.2, 0.4, 0.8)  # of the lines over height [m]
COLOURS = (style.ORANGE, style.GREEN, style.BLUE, style.PURPLE)
MARKS = {"plane": "o", "square": "s", "oblong": "D", "round": "v"}
NAMES = {
    "plane": "in the plane",
    "square": "square base, in space",
    "oblong": "base 1 to 2, in space",
    "round": "round base, in space",
}


def draw_toppling_velocity(
    medians: pd.DataFrame, pieces: pd.DataFrame, surface: Surface
) -> Figure:
    """Draw medians over height for some widths, and ratios over Kaneko's curve by slenderness.

    Parameters
    ----------
    medians : a row a size, standing, measure and limit, with ``median``, ``lower``, ``upper`` and ``kaneko_m_s``
    pieces : pieces of FEMA P-58 with ``fema_p58_m_s`` and the simulated medians
    surface : the fall in the plane, by PGV

    Returns
    -------
    The figure.
    """
    fell = medians[(medians["limit"] == 1) & (medians["measure"] == "pgv_m_s")]
    with style.panels(style.PAGE_WIDTH, 3.3, 1, 2) as (figure, (left, right)):
        _draw_heights(left, surface, pieces)
        _draw_ratios(right, fell, pieces)
        style.letter_panels((left, right))
        return figure


def _draw_heights(panel: Axes, surface: Surface, pieces: pd.DataFrame) -> None:
    """Medians in the plane over height: surface, simulations with their limits, Kaneko's curve and P-58."""
    for width, colour in zip(DRAWN_WIDTHS, COLOURS, strict=True):
        least = max(HEIGHTS[0], SLENDERNESSES[0] * width)
        heights = np.geomspace(least, min(HEIGHTS[1], SLENDERNESSES[1] * width), 60)
        medians, _ = surface.at(width, heights)
        panel.plot(heights, 100 * medians, color=colour)
        kaneko = [100 * kaneko_velocity(width, height) for height in heights.tolist()]
        panel.plot(heights, kaneko, "--", color=colour, linewidth=0.9)
        panel.annotate(
            f"{width:g} m",
            (heights[-1], 100 * medians[-1]),
            xytext=(3, 0),
            textcoords="offset points",
            color=colour,
            va="center",
        )
    _draw_with_limits(panel, pieces)
    panel.plot([], [], color=style.BLACK, label="simulated, in the plane")
    panel.plot([], [], "--", color=style.BLACK, linewidth=0.9, label="Kaneko")
    panel.set(xlabel="Height [m]", ylabel="Median velocity that topples [cm/s]")
    panel.set_title("by height, for four widths", loc="left")
    # room for the legend under the lines
    panel.set_ylim(bottom=1.5)
    style.plain_log(panel, "xy")
    panel.legend(loc="lower left")


def _draw_with_limits(panel: Axes, pieces: pd.DataFrame) -> None:
    """Pieces of FEMA P-58, and the same pieces simulated with their limits over earthquakes."""
    height, plane = pieces["height_m"], 100 * pieces["plane"]
    spread = 1.645 * pieces["plane_error"]
    limits = plane * (1 - np.exp(-spread)), plane * (np.exp(spread) - 1)
    panel.errorbar(
        height, plane, yerr=limits, fmt="o", color=style.BLACK, markersize=3,
        elinewidth=0.8, label="bookcases, simulated",
    )  # fmt: skip
    of_fema = 100 * pieces["fema_p58_m_s"]
    panel.plot(height, of_fema, "x", color=style.RED, label="bookcases, FEMA P-58")


def _draw_ratios(panel: Axes, fell: pd.DataFrame, pieces: pd.DataFrame) -> None:
    """Ratio over Kaneko's curve of all sizes by slenderness."""
    for (name, mark), colour in zip(MARKS.items(), COLOURS, strict=True):
        some = fell[fell["standing"] == name]
        ratio = some["median"] / some["kaneko_m_s"]
        slender = some["height_m"] / some["width_m"]
        panel.plot(
            slender, ratio, mark, color=colour, markersize=2.6, alpha=0.75,
            label=NAMES[name], markeredgewidth=0,
        )  # fmt: skip
        _draw_band(panel, some, colour)
    p58 = pieces["fema_p58_m_s"] / pieces["kaneko_m_s"]
    of_pieces = pieces["height_m"] / pieces["width_m"]
    panel.plot(of_pieces, p58, "x", color=style.RED, label="FEMA P-58")
    panel.axhline(1, color=style.BLACK, linestyle="--", linewidth=0.9)
    panel.set(xlabel="Height over width", ylabel="Median over that of Kaneko")
    panel.set_title("over Kaneko's curve, all sizes", loc="left")
    style.plain_log(panel, "xy")
    panel.legend(loc="upper right", ncols=2, columnspacing=0.8, handletextpad=0.2)
    panel.set_ylim(top=2.4)


def _draw_band(panel: Axes, some: pd.DataFrame, colour: str) -> None:
    """Shade the limits over earthquakes of the sizes of a standing, averaged by quarters of the slenderness.

    Parameters
    ----------
    panel : of ratios over Kaneko's velocity by height over width
    some : a row a size, with ``height_m``, ``width_m``, ``lower``, ``upper`` and ``kaneko_m_s``
    colour : of the standing
    """
    slender: Floats = (some["height_m"] / some["width_m"]).to_numpy()
    order = np.argsort(slender)
    for part in np.array_split(order, 4):
        rows = some.iloc[part]
        ratios = rows[["lower", "upper"]].div(rows["kaneko_m_s"], axis=0)
        limits = np.exp(np.log(ratios).mean())
        ends = slender[part].min(), slender[part].max()
        low, high = limits["lower"], limits["upper"]
        panel.fill_between(ends, low, high, color=colour, alpha=0.13, linewidth=0)
