"""Figures of a study of bodies in space: medians over planar ones, and fractions by level."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from rockfrag import figure_style as style
from rockfrag.rocking.space_medians import NO_LOSS, PLANAR

WORDS = {
    "one_component": "one component",
    "mean_direction": "mean of directions",
    "worst_direction": "worst direction",
}
COLOURS = dict(zip(PLANAR, (style.BLUE, style.ORANGE, style.GREEN), strict=True))


def words_of(row: pd.Series) -> str:
    """Return the base of a row in words, and that planar impacts lose nothing where they do not."""
    without = ", no loss" if row["planar_impacts"] == NO_LOSS else ""
    return f"{row['base']}{without}"


def ratios_figure(medians: pd.DataFrame) -> Figure:
    """Draw medians in space over the planar ones, with their limits."""
    with style.one_panel(style.PAGE_WIDTH, 0.6 + 0.2 * len(medians)) as (figure, panel):
        places = -np.arange(len(medians), dtype=float)
        for k, name in enumerate(PLANAR):
            value = medians[name].to_numpy()
            limits = medians[[f"{name}_lower", f"{name}_upper"]].to_numpy()
            off = places + 0.2 * (1 - k)
            panel.hlines(off, *limits.T, color=COLOURS[name], lw=1.0)
            panel.plot(value, off, "os^"[k], color=COLOURS[name], ms=3.5, label=WORDS[name])
        panel.axvline(1.0, color=style.BLACK, lw=0.8, ls="--")
        names = [
            f"{words_of(r)}, {r['slenderness']:g}, {r['height_m']:g} m"
            for _, r in medians.iterrows()
        ]
        panel.set_yticks(places, names)
        panel.set_ylim(places[-1] - 0.6, 0.6)
        panel.set_xlabel("Median level in space over that of planar rocking [-]; unsafe below 1")
        panel.set_ylabel("Base, height over width, height")
        figure.legend(loc="outside upper center", ncols=3)
        return figure


def fractions_figure(fractions: pd.DataFrame) -> Figure:
    """Draw the fraction of records that topple each body in space and in the plane, one panel a body."""
    bodies = list(fractions.groupby(["base", "slenderness", "height_m"], sort=False))
    columns = min(len(bodies), 6)
    rows = -(-len(bodies) // columns)
    with style.figure_style():
        figure = style.new_figure(style.PAGE_WIDTH, 0.6 + 1.35 * rows)
        panels = figure.subplots(rows, columns, sharey=True, squeeze=False)
        for panel, (about, part) in zip(panels.flat, bodies, strict=False):
            base, slenderness, height = about
            first = part[part["planar_impacts"] == part["planar_impacts"].iloc[0]]
            panel.plot(first["level_g"], first["space"], color=style.RED, label="in space")
            for name in PLANAR:
                line = {"color": COLOURS[name], "label": WORDS[name]}
                panel.plot(first["level_g"], first[name], lw=0.9, **line)
            style.plain_log(panel, "x")
            panel.set_title(f"{base}\n{slenderness:g}, {height:g} m", loc="left")
        for panel in list(panels.flat)[len(bodies) :]:
            panel.set_visible(False)
        figure.supxlabel("Level, geometric mean of both peaks [g]", fontsize=8)
        figure.supylabel("Fraction of records that topple it [-]", fontsize=8)
        handles = panels.flat[0].get_legend_handles_labels()
        figure.legend(*handles, loc="outside upper center", ncols=4)
        return figure
